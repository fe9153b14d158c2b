// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/map_drift.hpp"

#include "slam/core/scan/observability.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>

namespace waymark {
namespace {

constexpr double kRegion_m = 1.0;
constexpr double kMinWalls = 3.0;  // number of beams at right angles; less is noise of the normals

std::pair<int, int> key_of(const Eigen::Vector2d& place) {
  return {static_cast<int>(std::floor(place.x() / kRegion_m)),
          static_cast<int>(std::floor(place.y() / kRegion_m))};
}

/// Of the rigid motion whose covariance is known at one place, at another.
Eigen::Matrix3d carried(const Eigen::Matrix3d& covariance, const Eigen::Vector2d& step) {
  const Eigen::Matrix3d by = carried_along(step);
  return by * covariance * by.transpose();
}

/// Of covariances; those of many walls that tell a direction a little are none.
class Average {
 public:
  void add(double weight, const Eigen::Matrix3d& covariance) {
    weight_ += weight;
    sum_ += weight * covariance;
  }

  /// By how much; zero when nothing is known.
  Eigen::Matrix3d less_than(const Eigen::Matrix3d& other) const {
    if (weight_ < kMinWalls) return Eigen::Matrix3d::Zero();
    return positive_part(other - sum_ / weight_);
  }

 private:
  double weight_{0.0};
  Eigen::Matrix3d sum_{Eigen::Matrix3d::Zero()};
};

}  // namespace

Eigen::Matrix3d positive_part(const Eigen::Matrix3d& symmetric) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{symmetric};
  return axes.eigenvectors() * axes.eigenvalues().cwiseMax(0.0).asDiagonal() *
         axes.eigenvectors().transpose();
}

const MapDrift::Region* MapDrift::region_at(const Eigen::Vector2d& place_in_map) const {
  const auto region = regions_.find(key_of(place_in_map));
  return region == regions_.end() ? nullptr : &region->second;
}

void MapDrift::move(const Se2& map_from_base) {
  now_ = carried(now_, map_from_base.translation() - map_from_base_.translation());
  map_from_base_ = map_from_base;
}

Eigen::Matrix3d MapDrift::release(std::span<const AnnotatedBeam> beams,
                                  const Eigen::Vector2d& weak) {
  Average of_strong;
  Average of_weak;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Region* region = region_at(map_from_base_ * beams[i].beam.end_in_base);
    if (!region) continue;
    const auto normal = surface_normal(beams, static_cast<int>(i));
    if (!normal) continue;
    const Eigen::Matrix3d covariance =
        carried(region->covariance, map_from_base_.translation() - region->robot);
    const double told = std::pow(weak.dot(map_from_base_.rotation() * *normal), 2);
    of_weak.add(told, covariance);
    of_strong.add(1.0 - told, covariance);
  }
  Eigen::Matrix3d along_weak = Eigen::Matrix3d::Zero();
  along_weak.topLeftCorner<2, 2>() = weak * weak.transpose();
  const Eigen::Matrix3d others = Eigen::Matrix3d::Identity() - along_weak;
  const Eigen::Matrix3d since = others * of_strong.less_than(now_) * others +
                                along_weak * of_weak.less_than(now_) * along_weak;
  now_ = positive_part(now_ - since);
  return since;
}

void MapDrift::map(std::span<const AnnotatedBeam> beams) {
  for (const AnnotatedBeam& annotated : beams) {
    regions_.try_emplace(key_of(map_from_base_ * annotated.beam.end_in_base),
                         Region{now_, map_from_base_.translation()});
  }
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/map_drift.hpp"

#include <cmath>
#include <set>

namespace waymark {
namespace {

constexpr double kRegion_m = 1.0;
constexpr double kMinWalls = 3.0;  // number of beams at right angles; less is noise of the normals

std::pair<int, int> key_of(const Eigen::Vector2d& place) {
  return {static_cast<int>(std::floor(place.x() / kRegion_m)),
          static_cast<int>(std::floor(place.y() / kRegion_m))};
}

/// Of the rigid motion whose covariance is known at one place, at another.
PoseError carried(const PoseError& error, const Eigen::Vector2d& step) {
  const Eigen::Matrix3d by = carried_along(step);
  return {by * error.covariance * by.transpose(), by * error.by_errors};
}

/// Of errors; those of many walls that tell a direction a little are none.
class Average {
 public:
  void add(double weight, const PoseError& error) {
    weight_ += weight;
    covariance_ += weight * error.covariance;
    by_errors_ += weight * error.by_errors;
  }

  /// @param unknown  when nothing is known.
  PoseError mean_or(const PoseError& unknown) const {
    if (weight_ < kMinWalls) return unknown;
    return {covariance_ / weight_, by_errors_ / weight_};
  }

 private:
  double weight_{0.0};
  Eigen::Matrix3d covariance_{Eigen::Matrix3d::Zero()};
  PoseByErrors by_errors_{PoseByErrors::Zero()};
};

}  // namespace

const MapDrift::Region* MapDrift::region_at(const Eigen::Vector2d& place_in_map) const {
  const auto region = regions_.find(key_of(place_in_map));
  return region == regions_.end() ? nullptr : &region->second;
}

void MapDrift::move(const Se2& map_from_base) {
  now_ = carried(now_, map_from_base.translation() - map_from_base_.translation());
  map_from_base_ = map_from_base;
}

DriftFromWalls MapDrift::release(std::span<const AnnotatedBeam> beams, const Observability& walls,
                                 const ErrorsCovariance& errors_covariance) {
  const Eigen::Vector2d weak = map_from_base_.rotation() * walls.weak_direction;
  Average of_strong;
  Average of_weak;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Region* region = region_at(map_from_base_ * beams[i].beam.end_in_base);
    if (!region) continue;
    const auto normal = surface_normal(beams, static_cast<int>(i));
    if (!normal) continue;
    const auto here = [&](PoseError error) {
      error.covariance += region->noise / region->scans;
      return carried(error, map_from_base_.translation() - region->robot);
    };
    const double told = std::pow(weak.dot(map_from_base_.rotation() * *normal), 2);
    of_weak.add(told, here(region->whole));
    of_strong.add(1.0 - told, here(region->drawn));
  }
  const Eigen::Matrix3d others = without(weak);
  const Eigen::Matrix3d along_weak = Eigen::Matrix3d::Identity() - others;
  const PoseError strong = of_strong.mean_or(now_);
  const PoseError along = walls.is_degenerate ? now_ : of_weak.mean_or(now_);
  const Eigen::Matrix3d rest = rest_of(now_, errors_covariance);
  const Eigen::Matrix3d more = others * (rest - rest_of(strong, errors_covariance)) * others +
                               along_weak * (rest - rest_of(along, errors_covariance)) * along_weak;
  const PoseByErrors by_errors = others * (now_.by_errors - strong.by_errors) +
                                 along_weak * (now_.by_errors - along.by_errors);
  const DriftFromWalls drift{with_rest(positive_part(more), by_errors, errors_covariance),
                             positive_part(-more)};
  now_ = with_rest(positive_part(rest - positive_part(more)), now_.by_errors - by_errors,
                   errors_covariance);
  return drift;
}

void MapDrift::take(const PoseError& drawn, const Eigen::Matrix3d& by_noise,
                    const ErrorsCovariance& errors_covariance) {
  now_ = sum_of(now_, drawn, errors_covariance);
  noise_ = by_noise;
}

void MapDrift::map(std::span<const AnnotatedBeam> beams, const Eigen::Matrix3d& by_scan,
                   const PoseError& undrawn, const ErrorsCovariance& errors_covariance) {
  const PoseError drawn{now_.covariance - noise_ + by_scan, now_.by_errors};
  const PoseError whole = sum_of(drawn, undrawn, errors_covariance);
  std::set<std::pair<int, int>> seen;
  for (const AnnotatedBeam& annotated : beams)
    seen.insert(key_of(map_from_base_ * annotated.beam.end_in_base));
  for (const auto& key : seen) {
    Region& region = regions_[key];
    if (region.scans == 0) region.robot = map_from_base_.translation();
    const Eigen::Vector2d step = region.robot - map_from_base_.translation();
    const PoseError noise = carried({noise_, PoseByErrors::Zero()}, step);
    ++region.scans;
    const double share = 1.0 / region.scans;
    const auto average = [&](PoseError& mean, const PoseError& there) {
      mean.covariance += share * (there.covariance - mean.covariance);
      mean.by_errors += share * (there.by_errors - mean.by_errors);
    };
    average(region.drawn, carried(drawn, step));
    average(region.whole, carried(whole, step));
    region.noise += share * (noise.covariance - region.noise);
  }
}

}  // namespace waymark

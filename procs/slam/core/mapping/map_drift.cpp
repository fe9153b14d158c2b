// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/map_drift.hpp"

#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <vector>

namespace waymark {
namespace {

constexpr double kRegion_m = 1.0;
constexpr double kMinWalls = 3.0;  // number of beams at right angles; less is noise of the normals
constexpr double kRoughness = 0.04;       // of walls, share of the range's variance
constexpr double kBetterKnown_m2 = 1e-4;  // where walls and robot differ by less, both are used
constexpr int kWellMapped = 50;           // points in a region

/// Of the rigid motion whose covariance is known at one place, at another.
PoseError carried(const PoseError& error, const Eigen::Vector2d& step) {
  const Eigen::Matrix3d by = carried_along(step);
  return {by * error.covariance * by.transpose(), by * error.by_errors};
}

/// One of the errors that a mean is made of.
struct Part {
  Eigen::Matrix3d share{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d rest{Eigen::Matrix3d::Zero()};
};

/// Rest of sum(share * error), where the errors are those of one random walk at different times: a
/// larger one contains the smaller ones.
Eigen::Matrix3d rest_of_mean(std::vector<Part> parts) {
  std::stable_sort(parts.begin(), parts.end(),
                   [](const Part& a, const Part& b) { return a.rest(2, 2) < b.rest(2, 2); });
  Eigen::Matrix3d larger = Eigen::Matrix3d::Zero();
  for (const Part& part : parts)
    larger += part.share;
  Eigen::Matrix3d mean = Eigen::Matrix3d::Zero();
  for (const Part& part : parts) {
    larger -= part.share;
    const Eigen::Matrix3d with_larger = part.share * part.rest * larger.transpose();
    mean += part.share * part.rest * part.share.transpose() + with_larger + with_larger.transpose();
  }
  return mean;
}

}  // namespace

MapDrift::Place MapDrift::place_of(const Eigen::Vector2d& point_in_map) {
  return {static_cast<int>(std::floor(point_in_map.x() / kRegion_m)),
          static_cast<int>(std::floor(point_in_map.y() / kRegion_m))};
}

void MapDrift::move(const Se2& map_from_base) {
  now_ = carried(now_, map_from_base.translation() - map_from_base_.translation());
  map_from_base_ = map_from_base;
}

/// What the beams that end in each region tell of the robot's pose, map frame, relative to a range.
std::map<MapDrift::Place, Eigen::Matrix3d> MapDrift::told_by_regions(
    std::span<const AnnotatedBeam> beams) const {
  std::map<Place, Eigen::Matrix3d> told;
  for (std::size_t i = 0; i < beams.size(); ++i) {
    const Beam& beam = beams[i].beam;
    const Eigen::Vector2d lever = map_from_base_.rotation() * beam.end_in_base;
    const Place place = place_of(map_from_base_.translation() + lever);
    if (!regions_.contains(place)) continue;
    const auto normal_in_base = surface_normal(beams, static_cast<int>(i));
    if (!normal_in_base) continue;
    const Eigen::Vector2d normal = map_from_base_.rotation() * *normal_in_base;
    const Eigen::Vector3d row{normal.x(), normal.y(),
                              normal.y() * lever.x() - normal.x() * lever.y()};
    const double across = normal_in_base->dot(beam.end_in_base - beam.start_in_base) / beam.range_m;
    told.try_emplace(place, Eigen::Matrix3d::Zero()).first->second +=
        row * row.transpose() / (across * across + kRoughness);
  }
  return told;
}

/// The error that the robot has when it has been put to where the walls are that it sees: each
/// region pulls as much as its beams tell.
MapDrift::Error MapDrift::error_by(const std::vector<Seen>& seen,
                                   const ErrorsCovariance& errors_covariance) const {
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (const Seen& region : seen)
    all += region.told;
  const Eigen::Matrix3d inverse = all.completeOrthogonalDecomposition().pseudoInverse();
  const Eigen::Matrix3d untold = Eigen::Matrix3d::Identity() - inverse * all;
  std::vector<Part> parts{{untold, rest_of(now_, errors_covariance)}};
  PoseByErrors by_errors = untold * now_.by_errors;
  for (const Seen& region : seen) {
    const Eigen::Matrix3d share = inverse * region.told;
    parts.push_back({share, rest_of(region.error, errors_covariance)});
    by_errors += share * region.error.by_errors;
  }
  return {rest_of_mean(std::move(parts)), by_errors};
}

bool MapDrift::knows_better(const Seen& seen, const Eigen::Matrix3d& axes,
                            const ErrorsCovariance& errors_covariance) const {
  const Eigen::Matrix3d since =
      axes * (rest_of(now_, errors_covariance) - rest_of(seen.error, errors_covariance)) * axes;
  return since.topLeftCorner<2, 2>().trace() > kBetterKnown_m2 &&
         regions_.at(seen.place).points >= kWellMapped;
}

DriftFromWalls MapDrift::release(std::span<const AnnotatedBeam> beams, const Observability& walls,
                                 const ErrorsCovariance& errors_covariance) {
  better_known_.clear();
  const auto told = told_by_regions(beams);
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (const auto& [place, information] : told)
    all += information;
  if (all.topLeftCorner<2, 2>().trace() < kMinWalls) return {};

  const Eigen::Vector2d weak = map_from_base_.rotation() * walls.weak_direction;
  const Eigen::Matrix3d others = without(weak);
  const Eigen::Matrix3d along_weak = Eigen::Matrix3d::Identity() - others;
  const bool is_along_told =
      !walls.is_degenerate && weak.dot(all.topLeftCorner<2, 2>() * weak) >= kMinWalls;
  const Eigen::Matrix3d axes =
      is_along_told ? Eigen::Matrix3d{Eigen::Matrix3d::Identity()} : others;
  std::vector<Seen> seen;
  for (const auto& [place, information] : told) {
    const Region& region = regions_.at(place);
    seen.push_back({place, axes * information * axes,
                    carried(is_along_told ? region.whole : region.drawn,
                            map_from_base_.translation() - region.robot)});
    if (knows_better(seen.back(), axes, errors_covariance)) better_known_.insert(place);
  }

  const Error by_walls = error_by(seen, errors_covariance);
  const Eigen::Matrix3d rest = rest_of(now_, errors_covariance);
  const Eigen::Matrix3d less = rest - by_walls.rest;
  const Eigen::Matrix3d more = others * less * others + along_weak * less * along_weak;
  const PoseByErrors by_errors = now_.by_errors - by_walls.by_errors;
  const DriftFromWalls drift{with_rest(positive_part(more), by_errors, errors_covariance),
                             positive_part(-more)};
  now_ =
      with_rest(positive_part(rest - positive_part(more)), by_walls.by_errors, errors_covariance);
  return drift;
}

void MapDrift::take(const PoseError& drawn, const Eigen::Matrix3d& by_noise,
                    const ErrorsCovariance& errors_covariance) {
  now_ = sum_of(now_, drawn, errors_covariance);
  noise_ = by_noise;
}

void MapDrift::map(std::span<const AnnotatedBeam> beams, const Eigen::Matrix3d& by_scan,
                   const PoseError& undrawn, const ErrorsCovariance& errors_covariance) {
  std::map<Place, int> seen;
  for (const AnnotatedBeam& annotated : beams)
    ++seen[place_of(map_from_base_ * annotated.beam.end_in_base)];
  for (const auto& [place, points] : seen) {
    if (better_known_.contains(place)) continue;
    const auto [found, is_new] = regions_.try_emplace(place);
    Region& region = found->second;
    if (is_new) region.robot = map_from_base_.translation();
    // Where the scan was matched the pose has followed its noise, and its points lie right.
    PoseError drawn{now_.covariance + by_scan, now_.by_errors};
    if (!is_new) drawn.covariance -= noise_;
    region.points += points;
    const double share = static_cast<double>(points) / region.points;
    const auto average = [&](PoseError& mean, const PoseError& here) {
      const PoseError there = carried(here, region.robot - map_from_base_.translation());
      mean.covariance += share * (there.covariance - mean.covariance);
      mean.by_errors += share * (there.by_errors - mean.by_errors);
    };
    average(region.drawn, drawn);
    average(region.whole, sum_of(drawn, undrawn, errors_covariance));
  }
}

}  // namespace waymark

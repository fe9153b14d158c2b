// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/scan_registration.hpp"

#include "common/geometry/information.hpp"
#include "slam/core/localisation/map_fit.hpp"
#include "slam/core/mapping/moving_beams.hpp"
#include "slam/core/registration/wide_search.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr double kMinMapped = 0.6;  // share of mapped beams, for a scan to be in the loaded map

// A smaller error of the range scale is not significant, or within the accuracy of LiDARs.
constexpr double kMinRangeError = 0.01;  // relative
constexpr double kMinSigmas = 5.0;
constexpr double kClearlyBetter = 1.15;           // ratio of inliers with and without the scale
const Eigen::Vector3d kAround{0.05, 0.05, 0.02};  // sigmas of the pose about the prediction

Observation scaled_ranges(Observation observation, double error) {
  for (AnnotatedBeam& annotated : observation.beams) {
    Beam& beam = annotated.beam;
    beam.range_m /= 1.0 + error;
    beam.end_in_base = beam.start_in_base + (beam.end_in_base - beam.start_in_base) / (1.0 + error);
  }
  return observation;
}

Eigen::Matrix3d nearby(Eigen::Matrix3d covariance) {
  covariance.diagonal() += kAround.cwiseAbs2();
  return covariance;
}

Points still_points(const Points& points, const MapsForScan& maps, const Prediction& searched) {
  return without_moving(points, maps.grid, searched.map_from_base, searched.covariance);
}

/// Occupied points, in the frame of the match, around a pose.
Points occupied_near(const MatchedScan& scan, const Se2& submap_from_base, double within_m) {
  if (scan.submap != nullptr) return scan.submap->points();
  return scan.loaded->wall_points_near(submap_from_base.translation(), within_m);
}

}  // namespace

SubmapPrediction in_submap(const Prediction& prediction, const Se2& map_from_submap) {
  const Se2 submap_from_map = map_from_submap.inverse();
  return {submap_from_map * prediction.map_from_base,
          in_axes(submap_from_map.rotation(), prediction.covariance)};
}

Eigen::Matrix3d MatchedScan::information() const {
  return in_axes(map_from_submap.rotation(), match.observed.information);
}

ScanRegistration::ScanRegistration(const WaymarkConfig& config, double range_sigma_m)
    : config_{config.scan},
      min_score_{config.loops.min_score},
      usual_fit_{config.scan.min_inliers, config.min_inlier_share},
      range_noise_{range_sigma_m},
      range_scale_{config.scan.cell_spacing_m} {}

void ScanRegistration::match(const Observation& observation, const MapsForScan& maps,
                             ScanAtPrediction& scan) const {
  const std::size_t all = scan.points.size();
  scan.points = still_points(scan.points, maps, scan.searched);
  scan.beams_moving = all - scan.points.size();
  scan.matched = matched(scan.points, scan.searched, maps);
  // A scan that contradicts the map may fit at another pose; its range scale is tested only if it
  // fits none.
  if (scan.matched && usual_fit_.is_contradicted(scan.matched->match))
    search_widely(observation, maps, scan);
}

std::optional<MatchedScan> ScanRegistration::matched(const Points& points,
                                                     const Prediction& prediction,
                                                     const MapsForScan& maps) const {
  if (points.empty()) return std::nullopt;
  if (maps.loaded != nullptr) {
    const ScanMatch match = maps.loaded->match(points, prediction.map_from_base,
                                               prediction.covariance, range_noise_, config_);
    if (maps.is_fixed || is_in_loaded_map(match))
      return MatchedScan{.match = match, .loaded = maps.loaded};
  }
  if (maps.submap == nullptr) return std::nullopt;
  const NdtMap& ndt = maps.submap->ndt();
  const SubmapPrediction guess = in_submap(prediction, maps.map_from_submap);
  const ScanMatch plain = match_scan(points, ndt, guess.submap_from_base, guess.covariance,
                                     range_noise_, config_, maps.submap->coarse_ndt());
  return MatchedScan{
      .match = with_settled_walls(plain, points, ndt, guess.covariance, range_noise_, config_),
      .submap = maps.submap,
      .map_from_submap = maps.map_from_submap};
}

void ScanRegistration::search_widely(const Observation& observation, const MapsForScan& maps,
                                     ScanAtPrediction& scan) const {
  MatchedScan& matched = *scan.matched;
  if (scan.was_searched_widely || !usual_fit_.is_worse_than_usual(matched.match)) return;
  scan.was_searched_widely = true;
  const Se2 submap_from_last = matched.map_from_submap.inverse() * scan.map_from_last;
  const SubmapPrediction expected = in_submap(scan.expected, matched.map_from_submap);
  WideSearch search;
  for (const Se2& step : scan.steps_without_odometry)
    search.without_odometry.push_back(submap_from_last * step);
  search.by_odometry = expected.submap_from_base;
  search.odometry_covariance = expected.covariance;
  search.since_last_s = scan.since_last_s;
  search.driven_m = (submap_from_last.translation() - search.by_odometry.translation()).norm();
  search.min_score = min_score_;
  search.misfit = [&](const Se2& submap_from_base) {
    const Se2 map_from_base = matched.map_from_submap * submap_from_base;
    return fit_in_map(maps.grid, observation.beams, map_from_base).misfit();
  };
  matched.match = searched_widely(matched.match, scan.points, matched.ndt(),
                                  occupied_near(matched, expected.submap_from_base,
                                                wide_search_reach_m(scan.points, search.driven_m)),
                                  search, usual_fit_, range_noise_, config_);
}

/// If walls on opposite sides are all too far away, or all too near, no pose explains the scan: the
/// ranges are scaled.
std::optional<ScanRegistration::RescaledScan> ScanRegistration::rescaled(
    const Observation& observation, const MapsForScan& maps, const ScanAtPrediction& scan) const {
  const MatchedScan& plain = *scan.matched;
  const SubmapPrediction guess = in_submap(
      {scan.expected.map_from_base, nearby(scan.expected.covariance)}, plain.map_from_submap);
  const RangeScale scale =
      fit_range_scale(scan.points, observation.beams.front().beam.start_in_base, plain.ndt(),
                      guess.submap_from_base, guess.covariance, range_noise_);
  if (std::abs(scale.error) < std::max(kMinRangeError, kMinSigmas * scale.sigma))
    return std::nullopt;
  RescaledScan scaled{scale.error, scaled_ranges(observation, scale.error)};
  scaled.points = still_points(points_of(scaled.observation), maps, scan.searched);
  const auto fitted = matched(scaled.points, scan.searched, maps);
  if (!fitted || fitted->match.inliers < kClearlyBetter * plain.match.inliers ||
      usual_fit_.is_contradicted(fitted->match)) {
    return std::nullopt;
  }
  scaled.matched = *fitted;
  return scaled;
}

std::optional<Observation> ScanRegistration::with_right_scale(const Observation& observation,
                                                              const MapsForScan& maps,
                                                              ScanAtPrediction& scan) {
  is_rescaled_ = false;
  if (!scan.matched) return std::nullopt;
  if (!usual_fit_.is_contradicted(scan.matched->match)) {
    range_scale_.note_unscaled(scan.points, scan.matched->map_from_base());
    return std::nullopt;
  }
  std::optional<RescaledScan> scaled = rescaled(observation, maps, scan);
  if (!scaled || !range_scale_.try_accept(
                     scaled->range_error, scan.points, observation.beams.front().beam.start_in_base,
                     scan.expected.map_from_base, nearby(scan.expected.covariance), range_noise_)) {
    return std::nullopt;
  }
  scan.points = std::move(scaled->points);
  scan.matched = scaled->matched;
  is_rescaled_ = true;
  ++scans_rescaled_;
  range_scale_error_ = scaled->range_error;
  return std::move(scaled->observation);
}

void ScanRegistration::note_fit(const ScanMatch& match) {
  ++scans_;
  if (usual_fit_.is_refuted(match)) {
    ++scans_refuted_;
  } else if (!match.is_usable(config_)) {
    ++scans_unusable_;
  }
  if (usual_fit_.is_contradicted(match)) return;
  usual_fit_.note_scan(match);
  if (match.is_usable(config_) && !is_rescaled_)
    range_noise_.observe(match.range_scatter_m * match.range_scatter_m, match.num_scattered);
}

bool ScanRegistration::is_in_loaded_map(const ScanMatch& match) const {
  return is_usable(match) && match.mapped_share >= kMinMapped;
}

void ScanRegistration::report(SensorStatistics& statistics) const {
  statistics.range_sigma_m = std::sqrt(range_noise_.variance_m2());
  statistics.scans = scans_;
  statistics.scans_unusable = scans_unusable_;
  statistics.scans_refuted = scans_refuted_;
  statistics.scans_rescaled = scans_rescaled_;
  statistics.range_scale_error = range_scale_error_;
}

}  // namespace waymark

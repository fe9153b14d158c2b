// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator monitors the LiDAR: the noise of its ranges, and their scale.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/registration/range_scale.hpp"

#include <cmath>
#include <utility>

namespace waymark {
namespace {

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

}  // namespace

/// If walls on opposite sides are all too far away, or all too near, no pose explains the scan: the
/// ranges are scaled.
std::optional<WaymarkEstimator::RescaledScan> WaymarkEstimator::rescaled(
    const Observation& observation, const ScanAtPrediction& scan) const {
  const MatchedScan& plain = *scan.matched;
  const SubmapPrediction guess = in_submap(
      {scan.expected.map_from_base, nearby(scan.expected.covariance)}, plain.map_from_submap);
  const RangeScale scale =
      fit_range_scale(scan.points, observation.beams.front().beam.start_in_base, ndt_of(plain),
                      guess.submap_from_base, guess.covariance, range_noise_);
  if (std::abs(scale.error) < std::max(kMinRangeError, kMinSigmas * scale.sigma))
    return std::nullopt;
  RescaledScan scaled{scale.error, scaled_ranges(observation, scale.error)};
  scaled.points = without_moving(points_of(scaled.observation), scan.searched);
  const auto fitted = matched(scaled.points, scan.searched);
  if (!fitted || fitted->match.inliers < kClearlyBetter * plain.match.inliers ||
      usual_fit_.is_contradicted(fitted->match)) {
    return std::nullopt;
  }
  scaled.matched = *fitted;
  return scaled;
}

/// Rescales the ranges of a scan that fits only at another scale, if that scale is accepted.
/// @return the corrected observation; none: the measured one is used.
std::optional<Observation> WaymarkEstimator::with_right_scale(const Observation& observation,
                                                              ScanAtPrediction& scan) {
  is_rescaled_ = false;
  if (!scan.matched) return std::nullopt;
  if (!usual_fit_.is_contradicted(scan.matched->match)) {
    range_scale_.note_unscaled(scan.points,
                               scan.matched->map_from_submap * scan.matched->match.map_from_base);
    return std::nullopt;
  }
  std::optional<RescaledScan> scaled = rescaled(observation, scan);
  if (!scaled || !range_scale_.try_accept(
                     scaled->range_error, scan.points, observation.beams.front().beam.start_in_base,
                     scan.expected.map_from_base, nearby(scan.expected.covariance), range_noise_)) {
    return std::nullopt;
  }
  scan.points = std::move(scaled->points);
  scan.matched = scaled->matched;
  is_rescaled_ = true;
  ++statistics_.scans_rescaled;
  statistics_.range_scale_error = scaled->range_error;
  return std::move(scaled->observation);
}

void WaymarkEstimator::note_fit(const ScanMatch& match) {
  ++statistics_.scans;
  if (usual_fit_.is_refuted(match)) {
    ++statistics_.scans_refuted;
  } else if (!match.is_usable(config_.scan)) {
    ++statistics_.scans_unusable;
  }
  if (usual_fit_.is_contradicted(match)) return;
  usual_fit_.note_scan(match);
  if (match.is_usable(config_.scan) && !is_rescaled_)
    range_noise_.observe(match.range_scatter_m * match.range_scatter_m, match.num_scattered);
}

std::optional<SensorStatistics> WaymarkEstimator::statistics() const {
  SensorStatistics statistics = statistics_;
  const LearntOdometryNoise& learnt = graph_.noise().learnt_odometry;
  statistics.odometry_along = learnt.along;
  statistics.odometry_turn = learnt.turn;
  statistics.slips = noise_learner_.num_slips();
  statistics.slip_m_per_sqrt_m = std::sqrt(learnt.slip_m2_per_m);
  statistics.range_sigma_m = std::sqrt(range_noise_.variance_m2());
  statistics.described_range_sigma_m = setup_.range_sigma_m;
  if (loaded_map_) statistics.loaded_map = loaded_map_->fit();
  statistics.loops_ambiguous = loop_finder_.num_ambiguous();
  const Calibration variances = graph_.covariance({}, {}).diagonal();
  for (const std::size_t term : graph_.doubted_calibration_terms()) {
    const auto i = static_cast<Eigen::Index>(term);
    statistics.miscalibrated.push_back(
        {term, graph_.state().calibration[i], std::sqrt(variances[i])});
  }
  return statistics;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator monitors the LiDAR: the noise of its ranges, and their scale.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/registration/range_scale.hpp"

#include <cmath>
#include <utility>

namespace waymark {
namespace {

constexpr double kLeastShare = 0.01;  // of the ranges; less is within the accuracy of LiDARs
constexpr double kLeastSigmas = 5.0;
constexpr double kClearlyBetter = 1.15;           // ratio of inliers with and without the scale
const Eigen::Vector3d kAround{0.05, 0.05, 0.02};  // sigmas of the pose about the prediction

Observation scaled_ranges(Observation observation, double share) {
  for (AnnotatedBeam& annotated : observation.beams) {
    Beam& beam = annotated.beam;
    beam.range_m /= 1.0 + share;
    beam.end_in_base = beam.start_in_base + (beam.end_in_base - beam.start_in_base) / (1.0 + share);
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
    const Observation& observation, const Look& look) const {
  const MatchedScan& plain = *look.scan;
  const SubmapPrediction guess = in_submap(
      {look.expected.map_from_base, nearby(look.expected.covariance)}, plain.map_from_submap);
  const RangeScale scale =
      fit_range_scale(look.points, observation.beams.front().beam.start_in_base, ndt_of(plain),
                      guess.submap_from_base, guess.covariance, range_noise_);
  if (std::abs(scale.share) < std::max(kLeastShare, kLeastSigmas * scale.sigma))
    return std::nullopt;
  RescaledScan scaled{scale.share, scaled_ranges(observation, scale.share)};
  scaled.points = points_of(scaled.observation);
  const auto fitted = matched(scaled.points, look.expected);
  if (!fitted || fitted->match.inliers < kClearlyBetter * plain.match.inliers ||
      usual_fit_.is_contradicted(fitted->match)) {
    return std::nullopt;
  }
  scaled.scan = *fitted;
  return scaled;
}

/// Rescales the ranges of a scan that fits only at another scale, if that scale is believed.
/// @return the corrected observation; none: the measured one is used.
std::optional<Observation> WaymarkEstimator::with_right_scale(const Observation& observation,
                                                              Look& look) {
  is_rescaled_ = false;
  if (!look.scan) return std::nullopt;
  if (!usual_fit_.is_contradicted(look.scan->match)) {
    range_scale_.note_unscaled(look.points,
                               look.scan->map_from_submap * look.scan->match.map_from_base);
    return std::nullopt;
  }
  std::optional<RescaledScan> scaled = rescaled(observation, look);
  if (!scaled || !range_scale_.believes(
                     scaled->share, look.points, observation.beams.front().beam.start_in_base,
                     look.expected.map_from_base, nearby(look.expected.covariance), range_noise_)) {
    return std::nullopt;
  }
  look.points = std::move(scaled->points);
  look.scan = scaled->scan;
  is_rescaled_ = true;
  ++findings_.scans_rescaled;
  findings_.range_share = scaled->share;
  return std::move(scaled->observation);
}

void WaymarkEstimator::note_fit(const ScanMatch& match) {
  ++findings_.scans;
  if (usual_fit_.is_refuted(match)) {
    ++findings_.scans_refuted;
  } else if (!match.is_usable(config_.scan)) {
    ++findings_.scans_unusable;
  }
  if (usual_fit_.is_contradicted(match)) return;
  usual_fit_.note_scan(match);
  if (match.is_usable(config_.scan) && !is_rescaled_)
    range_noise_.observe(match.range_scatter_m * match.range_scatter_m, match.num_scattered);
}

std::optional<Findings> WaymarkEstimator::findings() const {
  Findings findings = findings_;
  const OdometryScale& scale = graph_.noise().scale;
  findings.odometry_along = scale.along;
  findings.odometry_turn = scale.turn;
  findings.slips = noise_learner_.num_slips();
  findings.slip_m_per_sqrt_m = std::sqrt(scale.slip_m2_per_m);
  findings.range_sigma_m = std::sqrt(range_noise_.variance_m2());
  findings.described_range_sigma_m = setup_.range_sigma_m;
  findings.loops_ambiguous = loop_finder_.num_ambiguous();
  const Calibration variances = graph_.covariance({}, {}).diagonal();
  for (const std::size_t term : graph_.doubted_calibration_terms()) {
    const auto i = static_cast<Eigen::Index>(term);
    findings.miscalibrated.push_back(
        {term, graph_.state().calibration[i], std::sqrt(variances[i])});
  }
  return findings;
}

}  // namespace waymark

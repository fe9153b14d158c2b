// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator monitors the LiDAR: the noise of its ranges, and their scale.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/registration/range_scale.hpp"

#include <cmath>

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

}  // namespace

/// If walls on opposite sides are all too far away, or all too near, no pose explains the scan: the
/// ranges are scaled.
std::optional<Observation> WaymarkEstimator::with_right_scale(const Observation& observation,
                                                              Look& look) {
  is_rescaled_ = false;
  if (!look.scan || !usual_fit_.is_contradicted(look.scan->match)) return std::nullopt;
  const Prediction& expected = look.expected;
  const auto& plain = look.scan;
  SubmapPrediction guess = in_submap(expected, plain->map_from_submap);
  guess.covariance.diagonal() += kAround.cwiseAbs2();
  const RangeScale scale =
      fit_range_scale(look.points, observation.beams.front().beam.start_in_base, ndt_of(*plain),
                      guess.submap_from_base, guess.covariance, range_noise_);
  if (std::abs(scale.share) < std::max(kLeastShare, kLeastSigmas * scale.sigma))
    return std::nullopt;
  Observation corrected = scaled_ranges(observation, scale.share);
  const Points points = points_of(corrected);
  const auto fitted = matched(points, expected);
  if (!fitted || fitted->match.inliers < kClearlyBetter * plain->match.inliers ||
      usual_fit_.is_contradicted(fitted->match)) {
    return std::nullopt;
  }
  look.points = points;
  look.scan = fitted;
  is_rescaled_ = true;
  ++findings_.scans_rescaled;
  findings_.range_share = scale.share;
  return corrected;
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

// SPDX-License-Identifier: BSD-3-Clause
// Wheels that slip, and pushes: what the odometry did not see.
#include "slam/core/estimators/waymark.hpp"

namespace waymark {
namespace {

// Of what wheels that slip, or a push, add to the odometry; twice as much at most is looked for.
constexpr double kSlip_m = 0.12;
constexpr double kSlip_rad = 0.12;
constexpr int kSlipStarts = 30;
constexpr double kFits = 0.85;      // share of the mapped beams that agree; mostly it is 0.95
constexpr double kSlipGain = 0.15;  // share of all beams that must agree there and nowhere else

bool is_near(const Eigen::Vector3d& slip) {
  return slip.head<2>().norm() < 2.0 * kSlip_m && std::abs(slip.z()) < 2.0 * kSlip_rad;
}

}  // namespace

PoseError WaymarkEstimator::slip_error() {
  const Eigen::Array3d sigma{kSlip_m, kSlip_m, kSlip_rad};
  return {sigma.square().matrix().asDiagonal(), PoseByErrors::Zero()};
}

void WaymarkEstimator::believe_scans_about_slips(const Observation& observation) {
  const auto by_scans = turn_between(updated_beams_, observation.beams, since_update_);
  if (!by_scans || !by_scans->contradicts_odometry) return;
  Se2& start_from_end = since_update_.start_from_end;
  since_update_.turn_rad += std::abs(angle_difference(by_scans->turn_rad, start_from_end.theta()));
  start_from_end = {start_from_end.translation(), by_scans->turn_rad};
  slipped_ = true;
}

/// Looked for where the best particle's walls do not fit near the expected pose, and believed only
/// where far more of the scan does: a place that has changed fits nowhere.
std::optional<Eigen::Vector3d> WaymarkEstimator::find_slip(const Belief& expected,
                                                           const Sensed& sensed) const {
  if (updates_ == 0 || sensed.verdict == KidnapWatch::Verdict::kDoubtful) return std::nullopt;
  const State& best = particles_.state(particles_.best());
  const Se2& from = expected.map_from_base();
  SurfaceMatch match;
  match_walls(best, expected, sensed, from, match);
  if (match.agreeing >= kFits * match.mapped) return std::nullopt;
  double most = match.agreeing + kSlipGain * match.beams;
  std::optional<Eigen::Vector3d> slip;
  Belief anywhere = expected;
  anywhere.widen(slip_error());
  Random random{setup_.seed, kSlipStream, updates_};
  for (int i = 0; i < kSlipStarts; ++i) {
    const Eigen::Vector3d start{kSlip_m * random.normal(), kSlip_m * random.normal(),
                                kSlip_rad * random.normal()};
    const Se2 found = match_walls(best, anywhere, sensed, deviated(from, start), match).mean;
    const Eigen::Vector3d away = deviation(from, found);
    if (match.agreeing < most || match.agreeing < kFits * match.mapped || !is_near(away)) continue;
    most = match.agreeing;
    slip = away;
  }
  return slip;
}

}  // namespace waymark

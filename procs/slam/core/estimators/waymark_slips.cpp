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

void WaymarkEstimator::watch_standstill(const Observation& observation) {
  if (observation.odometry_caught_up && stands_since_) undo_standstill();
  if (observation.motion.distance_m > 0.0 || observation.motion.turn_rad > 0.0) {
    stands_since_.reset();
  } else if (!stands_since_) {
    stands_since_ = observation.time;
    for (std::size_t i = 0; i < particles_.size(); ++i)
      particles_.state(i).map_from_stood = pose_now(i);
  }
}

/// Odometry was stuck, and tells now what was driven meanwhile. Known markers have carried the
/// robot some of that way, which must not count twice; new ones were mapped from where it was not.
void WaymarkEstimator::undo_standstill() {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    WaymarkParticle& particle = particles_.state(i);
    particle.belief.step(pose_now(i).inverse() * particle.map_from_stood);
    particle.belief.forget_since(*stands_since_);
    particle.map_from_base = particle.belief.map_from_base();
  }
  mean_ = mean_pose();
  kidnap_watch_ = {};
}

/// Since the last update. A scan alone may fit another one by chance: the walls decide.
std::optional<double> WaymarkEstimator::turn_that_contradicts_odometry(
    const Observation& observation) const {
  const auto by_scans = turn_between(updated_beams_, observation.beams, since_update_);
  if (!by_scans || !by_scans->contradicts_odometry) return std::nullopt;
  return angle_difference(by_scans->turn_rad, since_update_.start_from_end.theta());
}

/// Looked for where the best particle's walls do not fit near the expected pose, and believed only
/// where far more of the scan does: a place that has changed fits nowhere.
std::optional<Eigen::Vector3d> WaymarkEstimator::find_slip(const Belief& expected,
                                                           const Sensed& sensed) const {
  if (updates_ == 0 || sensed.verdict == KidnapWatch::Verdict::kDoubtful) return std::nullopt;
  const WaymarkParticle& best = particles_.state(particles_.best());
  const Se2& from = expected.map_from_base();
  const Eigen::Matrix3d open =
      carried_along(best.belief.pose_covariance(),
                    from.translation() - best.belief.map_from_base().translation());
  const ParticleUpdate update{shared(), sensed};
  SurfaceMatch match;
  update.match_walls(best, expected, open, from, match);
  if (match.agreeing >= kFits * match.mapped) return std::nullopt;
  double most = match.agreeing + kSlipGain * match.beams;
  std::optional<Eigen::Vector3d> slip;
  Belief anywhere = expected;
  anywhere.widen(slip_error({kSlip_m, 0.0, kSlip_rad}));
  Random random{setup_.seed, kSlipStream, updates_};
  for (int i = 0; i < kSlipStarts; ++i) {
    Eigen::Vector3d about = Eigen::Vector3d::Zero();
    if (turn_by_scans_ && i % 2 == 0) about.z() = *turn_by_scans_;
    const Eigen::Vector3d start{kSlip_m * random.normal(), kSlip_m * random.normal(),
                                kSlip_rad * random.normal()};
    const Se2 found =
        update.match_walls(best, anywhere, open, deviated(from, about + start), match).mean;
    const Eigen::Vector3d away = deviation(from, found);
    if (match.agreeing < most || match.agreeing < kFits * match.mapped || !is_near(away - about))
      continue;
    most = match.agreeing;
    slip = away;
  }
  return slip;
}

}  // namespace waymark

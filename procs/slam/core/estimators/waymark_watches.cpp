// SPDX-License-Identifier: BSD-3-Clause
// Sensors that are not what they are told to be.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/matching/range_scale.hpp"

namespace waymark {
namespace {

constexpr double kWallsOff_m2 = 4e-4;  // of walls, from where the robot is seen to be
constexpr double kWallsOff_rad2 = 1e-4;
constexpr double kRangesKnownFor_m = 10.0;  // driven

}  // namespace

/// Held to the walls of the best particle. Where these say nothing, what they said last still holds
/// for some way.
void WaymarkEstimator::watch_ranges(const Observation& observation) {
  since_ranges_told_m_ += observation.motion.distance_m;
  if (since_ranges_told_m_ > kRangesKnownFor_m) ranges_wrong_ = false;
  if (updates_ == 0) return;
  const WaymarkParticle& best = particles_.state(particles_.best());
  const auto [expected, added] =
      best.belief.predicted(since_update_.then(observation.motion), noise_);
  const Eigen::Vector3d walls_off{kWallsOff_m2, kWallsOff_m2, kWallsOff_rad2};
  SurfaceFinder walls{best.walls, observation.beams.size()};
  const auto scale =
      range_scale(observation.beams, walls, expected,
                  best.belief.pose_covariance() + added + Eigen::Matrix3d{walls_off.asDiagonal()},
                  config_.matching);
  if (!scale || !(scale->is_right() || scale->is_wrong())) return;
  ranges_wrong_ = scale->is_wrong();
  since_ranges_told_m_ = 0.0;
}

/// A calibration that is further off than it claims would be learnt too slowly, and all that hangs
/// on it would be off.
void WaymarkEstimator::watch_calibration() {
  const SightingSigmas told = setup_.sighting_sigmas;
  const Eigen::Vector3d found = mean_errors().tail<3>();
  Eigen::Vector3d squares = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    squares += particles_.weights()[i] * particles_.state(i).belief.sighting_errors().cwiseAbs2();
  const auto wider = told.doubted_by(found, belief().sighting_variances(),
                                     (squares - found.cwiseAbs2()).cwiseMax(0.0));
  if (!wider) return;
  calibration_widened_ = true;
  setup_.sighting_sigmas = *wider;
  for (std::size_t i = 0; i < particles_.size(); ++i)
    particles_.state(i).belief.widen_prior(told.learnt, wider->learnt);
}

}  // namespace waymark

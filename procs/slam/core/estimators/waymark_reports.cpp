// SPDX-License-Identifier: BSD-3-Clause
// What the estimator says: pose, landmarks, trajectory, map. It changes nothing.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/landmark/mean_landmarks.hpp"

namespace waymark {

Se2 WaymarkEstimator::mean_pose() const {
  const Se2& about = particles_.state(particles_.best()).map_from_base;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    mean += particles_.weights()[i] * deviation(about, particles_.state(i).map_from_base);
  return deviated(about, mean);
}

/// Of the mixture: what the particles' Gaussians leave open, and how far the particles disagree, or
/// should disagree if there were enough of them.
Eigen::Matrix3d WaymarkEstimator::covariance_about_mean() const {
  PoseError within = belief().pose_error();
  within.covariance.setZero();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    within.covariance += particles_.weights()[i] * particles_.state(i).belief.pose_covariance();
  const PoseError& drift = drift_.now();
  const Eigen::Matrix3d between = covariance_about(mean_, particles_);
  return sum_of(drift, within, belief().errors_covariance()).covariance +
         positive_part(between - drift.covariance);
}

/// Between updates the walls of the best particle hold the heading, which odometry loses fastest.
/// Nothing of it is kept.
Estimate WaymarkEstimator::estimate(const Observation& observation) const {
  const bool has_moved = since_update_.distance_m > 0.0 || since_update_.turn_rad > 0.0;
  Se2 map_from_base = mean_;
  Eigen::Matrix3d covariance = covariance_;
  if (has_moved) {
    const WaymarkParticle& best = particles_.state(particles_.best());
    const Belief::Prediction predicted = best.belief.predicted(since_update_, noise_);
    SurfaceFinder walls{best.walls, observation.beams.size()};
    const PoseProposal now = propose(
        predicted.map_from_base, predicted.covariance,
        [&](const Se2& pose, const Eigen::Matrix3d& uncertainty) {
          return match_surfaces(observation.beams, walls, pose, uncertainty, config_.matching).pose;
        });
    map_from_base = mean_ * (best.map_from_base.inverse() * now.mean);
    covariance += now.covariance;
  }
  Estimate estimate = describe_observation(observation, map_from_base, setup_.range_sigma_m);
  estimate.covariance = covariance;
  estimate.slipped = slipped_;
  estimate.ranges_wrong = ranges_wrong_;
  estimate.calibration_widened = calibration_widened_;
  estimate.num_particles = particles_.size();
  estimate.effective_particles = effective_particles_;
  estimate.weak_axis_source = markers_told_ ? WeakAxisSource::kMarkers : WeakAxisSource::kOdometry;
  const bool is_lost =
      verdict_ == KidnapWatch::Verdict::kDoubtful || wall_agreement_ < config_.lost_agreement;
  estimate.health =
      health_of(updates_, is_lost, !estimate.observability.is_degenerate || markers_told_);
  return estimate;
}

std::vector<Landmark> WaymarkEstimator::landmarks() const {
  std::vector<WeighedLandmarks> known;
  for (std::size_t i = 0; i < particles_.size(); ++i)
    known.push_back({particles_.state(i).belief.markers(), particles_.weights()[i]});
  return mean_landmarks(known, particles_.best(), config_.same_marker_within_m);
}

StaticErrors WaymarkEstimator::mean_errors() const {
  StaticErrors mean = StaticErrors::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    mean += particles_.weights()[i] * particles_.state(i).belief.static_errors();
  return mean;
}

Statics WaymarkEstimator::statics() const {
  Statics statics;
  statics.errors = mean_errors();
  statics.markers = landmarks();
  return statics;
}

std::vector<TimedPose> WaymarkEstimator::trajectory() const {
  return retrospect_.trajectory(statics(), config_.same_marker_within_m);
}

GridMap WaymarkEstimator::redrawn_map() const {
  return retrospect_.redrawn_map(setup_.grid, statics(), config_.same_marker_within_m);
}

std::vector<PublishedParticle> WaymarkEstimator::particles() const {
  std::vector<PublishedParticle> published;
  published.reserve(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const WaymarkParticle& particle = particles_.state(i);
    published.push_back({particle.belief.predicted(since_update_, noise_).map_from_base,
                         particle.previous_map_from_base, particles_.weights()[i]});
  }
  return published;
}

}  // namespace waymark

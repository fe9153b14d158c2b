// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/marker_matching.hpp"

#include "slam/core/weighting/wall_score.hpp"

namespace waymark {
namespace {

enum RandomStream : std::uint64_t { kMotionStream = 1, kResamplingStream = 2 };

}  // namespace

MarkerMatchingEstimator::MarkerMatchingEstimator(const EstimatorSetup& setup,
                                                 const MarkerMatchingConfig& config)
    : setup_{setup},
      config_{config},
      particles_{static_cast<std::size_t>(config.particles), State{}},
      mapper_{setup.grid} {}

Estimate MarkerMatchingEstimator::update(const Observation& observation) {
  since_update_ = since_update_.then(observation.motion);
  const std::uint64_t updates_before = updates_;
  if (updates_ == 0) {
    mapper_.insert(observation, best_, covariance_);
    ++updates_;
  } else if (setup_.gate.is_open(since_update_)) {
    propagate();
    weigh(observation);
    const State& best = particles_.state(particles_.best());
    best_ = best.map_from_base;
    covariance_ = covariance_about(best_, particles_);
    effective_particles_ = particles_.effective_number();
    mapper_.insert(observation, best_, covariance_);
    Random random{setup_.seed, kResamplingStream, updates_};
    particles_.resample_if_needed(config_.resample_threshold, random);
    since_update_ = {};
    ++updates_;
  }
  Estimate now = estimate(observation);
  now.updated = updates_ > updates_before;
  return now;
}

void MarkerMatchingEstimator::propagate() {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Random random{setup_.seed, kMotionStream, updates_, i};
    State& state = particles_.state(i);
    state.previous_map_from_base = state.map_from_base;
    state.map_from_base = state.map_from_base * sample_motion(since_update_, setup_.motion, random);
  }
}

void MarkerMatchingEstimator::weigh(const Observation& observation) {
  const std::vector<ObservedSpot> spots = observed_spots(
      observation, setup_.grid.face_spacing_m, setup_.grid.face_margin_m, config_.sighting_sigma_m);
  const Se2 predicted = mean_pose(particles_);
  const Observability observability =
      observability_of(observation.beams, predicted, setup_.range_sigma_m);
  std::vector<WallScore> walls(particles_.size());
  std::vector<double> markers(particles_.size());
  WallScore all;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const Se2& pose = particles_.state(i).map_from_base;
    walls[i] = wall_score(mapper_.map(), observation.beams,
                          observability.without_weak_part(pose, predicted));
    markers[i] = marker_score(mapper_.map(), spots, pose, config_.rewards);
    all.agreement += particles_.weights()[i] * walls[i].agreement;
    all.mapped += particles_.weights()[i] * walls[i].mapped;
  }
  const double expected = all.mapped > 0.0 ? all.agreement / all.mapped : 0.0;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.add_log_weight(i,
                              markers[i] + config_.rewards.weak_reward * walls[i].beyond(expected));
  }
  particles_.normalise();
  const std::size_t best = particles_.best();
  wall_agreement_ = walls[best].mapped > 0.0 ? walls[best].agreement / walls[best].mapped : 1.0;
  saw_known_markers_ = markers[best] > 0.0;
}

Estimate MarkerMatchingEstimator::estimate(const Observation& observation) const {
  const Se2 map_from_base = best_ * since_update_.start_from_end;
  Estimate estimate = describe_observation(observation, map_from_base, setup_.range_sigma_m);
  estimate.covariance = covariance_;
  estimate.num_particles = particles_.size();
  estimate.effective_particles = effective_particles_;
  estimate.weak_axis_source =
      saw_known_markers_ ? WeakAxisSource::kMarkers : WeakAxisSource::kOdometry;
  estimate.health = health_of(updates_, wall_agreement_ < config_.lost_agreement,
                              !estimate.observability.is_degenerate || saw_known_markers_);
  return estimate;
}

std::vector<PublishedParticle> MarkerMatchingEstimator::particles() const {
  std::vector<PublishedParticle> published;
  published.reserve(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const State& state = particles_.state(i);
    published.push_back({state.map_from_base * since_update_.start_from_end,
                         state.previous_map_from_base, particles_.weights()[i]});
  }
  return published;
}

}  // namespace waymark

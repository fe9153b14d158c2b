// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/gmapping.hpp"

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

enum RandomStream : std::uint64_t { kMotionStream = 1, kResamplingStream = 2 };

/// slam_gmapping's default of maxRange is the LiDAR's limit minus this.
constexpr double kBelowLidarRange_m = 0.01;

GmappingConfig with_ranges(GmappingConfig config, double lidar_range_max_m) {
  if (config.max_range_m == 0.0) config.max_range_m = lidar_range_max_m - kBelowLidarRange_m;
  if (config.max_usable_range_m == 0.0) config.max_usable_range_m = config.max_range_m;
  return config;
}

}  // namespace

GmappingEstimator::GmappingEstimator(const EstimatorSetup& setup, const GmappingConfig& config)
    : setup_{setup},
      config_{with_ranges(config, setup.range_max_m)},
      matcher_{config.matcher, GridFrame::centred_on_map_origin(setup.grid.resolution_m)},
      particles_{static_cast<std::size_t>(config.particles), State{}},
      published_map_{matcher_.frame, config_.max_usable_range_m, config.occupied_threshold} {}

Estimate GmappingEstimator::update(const Observation& observation) {
  const bool is_first = updates_ == 0;
  const auto missing_rad = config_.watch_turns
                               ? turn_monitor_.missing_turn(observation.beams, observation.motion)
                               : std::nullopt;
  const Motion missing = Motion::between({}, {0.0, 0.0, missing_rad.value_or(0.0)});
  const Motion motion = missing_rad ? observation.motion.then(missing) : observation.motion;
  propagate(motion);
  updated_at_ += observation.clock_set;
  // As in the released code, which knows odometry at scans only: jitter in between is not driven.
  since_update_ = since_update_.then(Motion::between({}, motion.start_from_end));
  const bool is_due = config_.gate.is_open(since_update_, observation.time - updated_at_);
  const bool is_update = is_first || (is_due && !observation.beams.empty());
  scan_trajectory_.add(observation.time, motion, is_update);
  if (is_update) {
    auto scan = std::make_shared<const StoredScan>(beams_in_range(observation));
    if (!is_first) match_and_weigh(*scan);
    resample_and_register(scan);
    since_update_ = {};
    updated_at_ = observation.time;
    ++updates_;
  }
  ++observations_;
  Estimate now = estimate(observation);
  now.updated = is_update;
  now.odometry_refused = missing_rad.has_value();
  return now;
}

void GmappingEstimator::propagate(const Motion& motion) {
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Random random{setup_.seed, kMotionStream, observations_, i};
    State& state = particles_.state(i);
    state.map_from_base =
        state.map_from_base * sample_step(motion.start_from_end, config_.motion, random);
  }
}

StoredScan GmappingEstimator::beams_in_range(const Observation& observation) const {
  StoredScan beams;
  beams.reserve(observation.beams.size());
  for (const AnnotatedBeam& annotated : observation.beams) {
    if (annotated.beam.range_m <= config_.max_range_m) beams.push_back(annotated.beam);
  }
  return beams;
}

void GmappingEstimator::match_and_weigh(std::span<const Beam> beams) {
  StoredScan usable;
  std::copy_if(beams.begin(), beams.end(), std::back_inserter(usable),
               [&](const Beam& beam) { return beam.range_m <= config_.max_usable_range_m; });
  std::vector<double> log_likelihoods(particles_.size());
  setup_.parallel_for(particles_.size(), [&](std::size_t i) {
    State& state = particles_.state(i);
    ScanMatcher matcher{matcher_, state.hits, usable};
    const ScanMatcher::Match match = matcher.climb(state.map_from_base);
    state.is_matched = match.score > config_.minimum_score;
    if (state.is_matched) state.map_from_base = match.map_from_base;
    log_likelihoods[i] = matcher.log_likelihood(state.map_from_base);
  });

  // The released code divides all log weights by ogain N before it compares them.
  const double smoothing = config_.likelihood_gain * config_.particles;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    particles_.state(i).log_likelihood += log_likelihoods[i];
    particles_.add_log_weight(i, log_likelihoods[i] / smoothing);
  }
  particles_.normalise();
  effective_particles_ = particles_.effective_number();
}

void GmappingEstimator::resample_and_register(const std::shared_ptr<const StoredScan>& scan) {
  Random random{setup_.seed, kResamplingStream, updates_};
  const bool has_resampled =
      !particles_.resample_if_needed(config_.resample_threshold, random).empty();

  setup_.parallel_for(particles_.size(), [&](std::size_t i) {
    State& state = particles_.state(i);
    state.previous_map_from_base =
        state.trajectory ? state.trajectory->map_from_base : state.map_from_base;
    for (const Beam& beam : *scan) {
      if (beam.range_m > config_.max_usable_range_m) continue;
      add_hit(matcher_.frame, state.map_from_base * beam.end_in_base, state.hits);
    }
    state.trajectory =
        std::make_shared<TrajectoryNode>(state.map_from_base, scan, std::move(state.trajectory));
  });

  best_ = 0;
  std::vector<Trajectory> trajectories;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const State& state = particles_.state(i);
    if (state.log_likelihood > particles_.state(best_).log_likelihood) best_ = i;
    trajectories.push_back(state.trajectory);
  }
  map_from_best_ = particles_.state(best_).map_from_base;
  if (!has_resampled) return;
  if (const Trajectory trunk = common_ancestor(std::move(trajectories))) finalise(trunk);
}

void GmappingEstimator::finalise(const Trajectory& trunk) {
  const std::vector<Se2> poses = poses_along(trunk);
  common_poses_.insert(common_poses_.end(), poses.begin(), poses.end());
  published_map_.finalise(trunk);
}

std::vector<TimedPose> GmappingEstimator::trajectory() const {
  std::vector<Se2> poses = common_poses_;
  const std::vector<Se2> newer = poses_along(particles_.state(best_).trajectory);
  poses.insert(poses.end(), newer.begin(), newer.end());
  return scan_trajectory_.along(poses);
}

const GridMap& GmappingEstimator::map() const {
  return published_map_.along(particles_.state(best_).trajectory);
}

Estimate GmappingEstimator::estimate(const Observation& observation) const {
  // Between updates the pose follows odometry without the particles' noise.
  const Se2 map_from_base = map_from_best_ * since_update_.start_from_end;
  Estimate estimate = describe_observation(observation, map_from_base, setup_.range_sigma_m);
  estimate.covariance = covariance_about(map_from_base, particles_);
  estimate.num_particles = particles_.size();
  estimate.effective_particles = effective_particles_;
  estimate.weak_axis_source = WeakAxisSource::kOdometry;
  estimate.health = health_of(updates_, !particles_.state(best_).is_matched,
                              !estimate.observability.is_degenerate);
  return estimate;
}

std::vector<PublishedParticle> GmappingEstimator::particles() const {
  std::vector<PublishedParticle> published;
  published.reserve(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const State& state = particles_.state(i);
    published.push_back(
        {state.map_from_base, state.previous_map_from_base, particles_.weights()[i]});
  }
  return published;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/waymark.hpp"

#include <algorithm>
#include <tuple>

namespace waymark {
namespace {

enum RandomStream : std::uint64_t { kPoseStream = 1, kResamplingStream = 2 };

constexpr double kMinMappedShare = 0.2;  // of a scan's beams; fewer say nothing about being lost

Eigen::Matrix3d turned(const Eigen::Matrix3d& covariance, const Se2& map_from_base) {
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() = map_from_base.rotation();
  return turn * covariance * turn.transpose();
}

}  // namespace

WaymarkEstimator::WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config)
    : setup_{setup},
      config_{config},
      particles_{static_cast<std::size_t>(config.particles),
                 State{GridFrame::centred_on_map_origin(setup.grid.resolution_m), config.odometry}},
      mapper_{setup.grid} {
  config_.matching.range_sigma_m = setup.range_sigma_m;
}

Estimate WaymarkEstimator::update(const Observation& observation) {
  since_update_ = since_update_.then(observation.motion);
  if (updates_ == 0 || is_due()) {
    process(observation);
    mapper_.insert(observation, mean_, covariance_);
    Random random{setup_.seed, kResamplingStream, updates_};
    particles_.resample_if_needed(config_.resample_threshold, random);
    since_update_ = {};
    ++updates_;
  }
  return estimate(observation);
}

bool WaymarkEstimator::is_due() const {
  return since_update_.distance_m >= config_.update_distance_m ||
         since_update_.turn_rad >= config_.update_turn_rad;
}

void WaymarkEstimator::process(const Observation& observation) {
  const auto measurements =
      measure_markers(observation, setup_.range_sigma_m, setup_.base_from_camera, config_.markers);
  std::vector<Step> steps(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i)
    steps[i] = prepare(particles_.state(i), observation, measurements);
  const std::vector<Eigen::Vector3d> normals = centred_normals();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const PoseProposal& proposal = steps[i].proposal;
    State& state = particles_.state(i);
    move(state, updates_ == 0 ? Se2{} : proposal.at(normals[i]), steps[i], measurements);
    for (const AnnotatedBeam& annotated : observation.beams)
      state.walls.add(state.map_from_base * annotated.beam.end_in_base);
    particles_.add_log_weight(i, proposal.log_evidence - steps[i].penalty);
  }
  particles_.normalise();
  judge(steps);
}

WaymarkEstimator::Step WaymarkEstimator::prepare(
    const State& state, const Observation& observation,
    const std::vector<MarkerMeasurement>& measurements) const {
  Step step;
  const Se2 prior_mean = state.map_from_base * state.calibration.corrected(since_update_);
  const Eigen::Matrix3d prior_covariance =
      turned(state.calibration.covariance(since_update_, config_.odometry), state.map_from_base);
  const PoseProposal by_walls = propose(prior_mean, prior_covariance, [&](const Se2& pose) {
    step.walls = match_surfaces(observation.beams, state.walls, pose, config_.matching);
    PoseInformation walls = step.walls.pose;
    walls.cost *= config_.scan_evidence;
    return walls;
  });
  step.proposal = by_walls;
  associate(state, measurements, step);
  step.proposal = propose(by_walls.mean, by_walls.covariance, [&](const Se2& pose) {
    PoseInformation markers;
    for (const auto& [measurement, landmark] : step.known) {
      markers +=
          information_of(state.markers.compare_with(landmark, measurements[measurement], pose));
    }
    return markers;
  });
  step.proposal.log_evidence += by_walls.log_evidence;
  return step;
}

void WaymarkEstimator::associate(const State& state,
                                 const std::vector<MarkerMeasurement>& measurements,
                                 Step& step) const {
  for (std::size_t i = 0; i < measurements.size(); ++i) {
    const auto nearest =
        state.markers.nearest(measurements[i], step.proposal.mean, step.proposal.covariance);
    if (nearest && nearest->distance < config_.marker_gate) {
      step.known.emplace_back(i, nearest->innovation.landmark);
      continue;
    }
    step.penalty += 0.5 * config_.marker_gate;
    if (!nearest || nearest->distance_m > config_.same_marker_within_m) step.fresh.push_back(i);
  }
}

/// Standard normal samples whose weighted mean is exactly zero and whose spread is kept: the mean
/// of the particles then follows the mean of the proposals, without sampling noise.
std::vector<Eigen::Vector3d> WaymarkEstimator::centred_normals() const {
  std::vector<Eigen::Vector3d> normals;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Random random{setup_.seed, kPoseStream, updates_, i};
    normals.emplace_back(random.normal(), random.normal(), random.normal());
    mean += particles_.weights()[i] * normals.back();
  }
  const double shrunk = 1.0 - 1.0 / particles_.effective_number();
  if (shrunk < 0.5) return normals;  // one particle has nearly all the weight
  for (Eigen::Vector3d& normal : normals)
    normal = (normal - mean) / std::sqrt(shrunk);
  return normals;
}

void WaymarkEstimator::move(State& state, const Se2& map_from_base, const Step& step,
                            const std::vector<MarkerMeasurement>& measurements) const {
  state.previous_map_from_base = state.map_from_base;
  state.map_from_base = map_from_base;
  if (updates_ > 0) {
    state.calibration.learn(since_update_, state.previous_map_from_base.inverse() * map_from_base,
                            config_.odometry);
  }
  for (const auto& [measurement, landmark] : step.known)
    state.markers.update(landmark, measurements[measurement], map_from_base);
  for (const std::size_t measurement : step.fresh)
    state.markers.add(measurements[measurement], map_from_base);
}

void WaymarkEstimator::judge(const std::vector<Step>& steps) {
  mean_ = mean_pose();
  covariance_ = covariance_about(mean_, particles_);
  effective_particles_ = particles_.effective_number();
  const Step& best = steps[particles_.best()];
  best_ = particles_.state(particles_.best());
  best_->map_from_base = updates_ == 0 ? Se2{} : best.proposal.mean;
  const bool is_mapped = best.walls.mapped > kMinMappedShare * best.walls.beams;
  wall_agreement_ = is_mapped ? best.walls.agreeing / best.walls.mapped : 1.0;
  markers_told_ = !best.known.empty();
}

Se2 WaymarkEstimator::mean_pose() const {
  const Se2& about = particles_.state(particles_.best()).map_from_base;
  Eigen::Vector3d mean = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < particles_.size(); ++i)
    mean += particles_.weights()[i] * deviation(about, particles_.state(i).map_from_base);
  return deviated(about, mean);
}

const OdometryCalibration& WaymarkEstimator::calibration() const {
  return best_->calibration;
}

/// Where the best particle is now: between updates its walls hold the heading, which odometry loses
/// fastest. Nothing of it is kept.
PoseProposal WaymarkEstimator::track(const Observation& observation) const {
  const Se2 predicted = best_->map_from_base * calibration().corrected(since_update_);
  const Eigen::Matrix3d covariance =
      turned(calibration().covariance(since_update_, config_.odometry), best_->map_from_base);
  return propose(predicted, covariance, [&](const Se2& pose) {
    return match_surfaces(observation.beams, best_->walls, pose, config_.matching).pose;
  });
}

Estimate WaymarkEstimator::estimate(const Observation& observation) const {
  const bool has_moved = since_update_.distance_m > 0.0 || since_update_.turn_rad > 0.0;
  Se2 map_from_base = mean_;
  Eigen::Matrix3d covariance = covariance_;
  if (has_moved) {
    const PoseProposal now = track(observation);
    map_from_base = mean_ * (best_->map_from_base.inverse() * now.mean);
    covariance += now.covariance;
  }
  Estimate estimate = describe_observation(observation, map_from_base, setup_.range_sigma_m);
  estimate.covariance = covariance;
  estimate.num_particles = particles_.size();
  estimate.effective_particles = effective_particles_;
  estimate.weak_axis_source = markers_told_ ? WeakAxisSource::kMarkers : WeakAxisSource::kOdometry;
  if (updates_ < 2) {
    estimate.health = Health::kInitialising;
  } else if (wall_agreement_ < config_.lost_agreement) {
    estimate.health = Health::kLost;
  } else if (estimate.observability.is_degenerate && !markers_told_) {
    estimate.health = Health::kDegenerate;
  } else {
    estimate.health = Health::kTracking;
  }
  return estimate;
}

std::vector<Landmark> WaymarkEstimator::landmarks() const {
  const MarkerLandmarks& best = particles_.state(particles_.best()).markers;
  std::vector<Landmark> landmarks;
  for (std::size_t i = 0; i < best.size(); ++i) {
    Landmark landmark = best[i];
    double weight = 0.0;
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    Eigen::Matrix3d within = Eigen::Matrix3d::Zero();
    Eigen::Matrix3d squares = Eigen::Matrix3d::Zero();
    for (std::size_t p = 0; p < particles_.size(); ++p) {
      // Particles meet markers in the same order unless they disagree about which one it is.
      const MarkerLandmarks& others = particles_.state(p).markers;
      if (i >= others.size() || others[i].id != landmark.id) continue;
      const Eigen::Vector3d away = deviation(best[i].map_from_marker, others[i].map_from_marker);
      if (away.head<2>().norm() > config_.same_marker_within_m) continue;
      const double share = particles_.weights()[p];
      weight += share;
      mean += share * away;
      within += share * others[i].covariance;
      squares += share * away * away.transpose();
    }
    mean /= weight;
    landmark.map_from_marker = deviated(best[i].map_from_marker, mean);
    landmark.covariance = within / weight + squares / weight - mean * mean.transpose();
    landmarks.push_back(landmark);
  }
  std::sort(landmarks.begin(), landmarks.end(), [](const Landmark& a, const Landmark& b) {
    return std::tie(a.id, a.instance) < std::tie(b.id, b.instance);
  });
  return landmarks;
}

std::vector<PublishedParticle> WaymarkEstimator::particles() const {
  std::vector<PublishedParticle> published;
  published.reserve(particles_.size());
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const State& state = particles_.state(i);
    published.push_back({state.map_from_base * state.calibration.corrected(since_update_),
                         state.previous_map_from_base, particles_.weights()[i]});
  }
  return published;
}

}  // namespace waymark

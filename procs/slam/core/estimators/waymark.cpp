// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/waymark.hpp"

#include "slam/core/filter/centred_normals.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr std::size_t kStaticMarkers = 4;  // that a past pose is corrected by
constexpr double kMinSurfaces = 0.1;       // share of beams; a scan with fewer shows nothing
constexpr double kMinMappedShare = 0.2;    // of a scan's beams; fewer say nothing about being lost

/// What the robot's description says is not for the configuration to say again.
WaymarkConfig on_robot(const EstimatorSetup& setup, WaymarkConfig config) {
  config.matching.range_sigma_m = setup.range_sigma_m;
  config.odometry.half_track_m = setup.half_track_m;
  return config;
}

}  // namespace

WaymarkEstimator::WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config)
    : setup_{setup},
      config_{on_robot(setup, config)},
      particles_{static_cast<std::size_t>(config.particles),
                 WaymarkParticle{GridFrame::centred_on_map_origin(setup.grid.resolution_m),
                                 BeliefPrior{config_.odometry, setup.sighting_sigmas.learnt}}},
      mapper_{setup.grid} {
  noise_ = config_.odometry;
}

Estimate WaymarkEstimator::update(const Observation& observation) {
  watch_ranges(observation);
  if (surface_share(observation.beams) >= kMinSurfaces && !ranges_wrong_)
    return update_by(observation);
  // A LiDAR that measures nonsense must neither be matched nor mapped.
  Observation without_beams = observation;
  without_beams.beams.clear();
  return update_by(without_beams);
}

Estimate WaymarkEstimator::update_by(const Observation& observation) {
  watch_standstill(observation);
  since_update_ = since_update_.then(observation.motion);
  turn_by_scans_ = turn_that_contradicts_odometry(observation);
  slipped_ = false;
  calibration_widened_ = false;
  const std::uint64_t updates_before = updates_;
  if (updates_ == 0 || is_due() || turn_by_scans_ || is_contradicted_by(observation)) {
    process(observation);
    if (verdict_ != KidnapWatch::Verdict::kDoubtful)
      mapper_.insert(observation, mean_, covariance_);
    remember(observation);
    Random random{setup_.seed, kResamplingStream, updates_};
    particles_.resample_if_needed(config_.resample_threshold, random);
    since_update_ = {};
    if (!observation.beams.empty()) updated_beams_ = observation.beams;
    ++updates_;
  }
  Estimate now = estimate(observation);
  now.updated = updates_ > updates_before;
  retrospect_.add_scan(observation.time, now.map_from_base);
  return now;
}

bool WaymarkEstimator::is_due() const {
  return since_update_.distance_m >= config_.update_distance_m ||
         since_update_.turn_rad >= config_.update_turn_rad;
}

std::vector<MarkerMeasurement> WaymarkEstimator::measured(const Observation& observation) const {
  return measure_markers(
      observation, {setup_.range_sigma_m, setup_.camera.base_from_camera, setup_.sighting_sigmas},
      noise_, config_.markers);
}

Belief WaymarkEstimator::belief_now() const {
  Belief now = belief();
  now.move(since_update_, noise_);
  return now;
}

/// A marker where none of its id should be may mean that the robot was carried away: that cannot
/// wait until it has driven on.
bool WaymarkEstimator::is_contradicted_by(const Observation& observation) const {
  if (observation.sightings.empty()) return false;
  const Belief expected = belief_now();
  const auto seen = measured(observation);
  return std::any_of(seen.begin(), seen.end(), [&](const MarkerMeasurement& measurement) {
    const auto nearest = expected.nearest(measurement);
    return nearest && !nearest->may_be_it(config_.marker_gate, config_.marker_near_m);
  });
}

void WaymarkEstimator::process(const Observation& observation) {
  const Sensed sensed = sense(observation);
  const std::vector<Chance> chances = draw_chances();
  std::vector<Outcome> outcomes(particles_.size());
  const ParticleUpdate update{shared(), sensed};
  setup_.parallel_for(particles_.size(), [&](std::size_t i) {
    outcomes[i] = update.advance(particles_.state(i), chances[i]);
    particles_.state(i).belief.settle_oldest(static_cast<std::size_t>(config_.joint_markers));
  });
  weigh(outcomes);
  if (verdict_ == KidnapWatch::Verdict::kSettled) {
    const PoseCorrection& correction = outcomes[particles_.best()].correction;
    noise_growth_.learn(correction);
    slip_watch_.learn(correction, since_update_, config_.odometry);
  }
  noise_ = noise_growth_.applied_to(config_.odometry);
  watch_calibration();
  const Outcome& best = outcomes[particles_.best()];
  slipped_ = sensed.slip || best.slipped_turn_rad != 0.0;
  drift_.take(best.drawn, best.by_noise, belief().errors_covariance());
  judge(outcomes);
  drift_.move(mean_);
  if (verdict_ == KidnapWatch::Verdict::kDoubtful) return;
  // The first pose is exact, and what is mapped from there is off by what the scan's noise makes of
  // it, for ever. Later poses follow the noise of their scans.
  const Eigen::Matrix3d by_scan =
      updates_ == 0 ? noise_of_walls(observation.beams, config_.matching) : Eigen::Matrix3d::Zero();
  drift_.map(observation.beams, by_scan, belief().pose_error(), belief().errors_covariance());
}

WaymarkEstimator::Sensed WaymarkEstimator::sense(const Observation& observation) {
  Sensed sensed;
  sensed.observation = &observation;
  sensed.is_first = updates_ == 0;
  sensed.motion = since_update_;
  sensed.noise = noise_;
  sensed.markers = measured(observation);
  sensed.walls = observability_of(observation.beams, Se2{}, setup_.range_sigma_m);
  if (config_.id_layer_evidence > 0.0)
    sensed.spots = judged_spots(observation, setup_.grid.face_spacing_m, setup_.grid.face_margin_m);
  if (!sensed.walls.is_degenerate) {
    // What older scans have left open is the error of their walls, too.
    drift_.take(belief().pose_error(), Eigen::Matrix3d::Zero(), belief().errors_covariance());
  }
  const Belief expected = belief_now();
  verdict_ = kidnap_watch_.judge(expected, sensed.markers, since_update_, config_.marker_gate,
                                 config_.marker_near_m);
  sensed.verdict = verdict_;
  if (verdict_ == KidnapWatch::Verdict::kBack)
    sensed.returning_pose = kidnap_watch_.returning_pose();
  if (verdict_ == KidnapWatch::Verdict::kElsewhere)
    sensed.relocating_marker = kidnap_watch_.relocating_marker();
  drift_.move(expected.map_from_base());
  sensed.drift = drift_.release(observation.beams, sensed.walls, expected.errors_covariance());
  sensed.slip = find_slip(expected, sensed);
  return sensed;
}

std::vector<WaymarkEstimator::Chance> WaymarkEstimator::draw_chances() const {
  const auto normals_of = [&](RandomStream stream) {
    return centred_normals(particles_.weights(), [&, stream](std::size_t particle) {
      return Random{setup_.seed, stream, updates_, particle};
    });
  };
  const std::vector<Eigen::Vector3d> poses = normals_of(kPoseStream);
  const std::vector<Eigen::Vector3d> rests = normals_of(kRestStream);
  std::vector<Chance> chances;
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    Random random{setup_.seed, kStartStream, updates_, i};
    chances.push_back({config_.drawn_spread * poses[i], config_.drawn_spread * rests[i],
                       i == 0 ? 0.0 : random.normal()});
  }
  return chances;
}

/// Beams err together, so that a few units of evidence are chance: what is less than the knee
/// counts with its square. A particle that has lost its walls has less by far more than that.
void WaymarkEstimator::weigh(const std::vector<Outcome>& outcomes) {
  double most = outcomes.front().log_evidence;
  for (const Outcome& outcome : outcomes)
    most = std::max(most, outcome.log_evidence);
  for (std::size_t i = 0; i < particles_.size(); ++i) {
    const double less = most - outcomes[i].log_evidence;
    particles_.add_log_weight(i, -less / (1.0 + config_.evidence_knee / less));
  }
  particles_.normalise();
}

void WaymarkEstimator::judge(const std::vector<Outcome>& outcomes) {
  mean_ = mean_pose();
  covariance_ = covariance_about_mean();
  if (kidnap_watch_.elsewhere()) {
    const Eigen::Vector3d away = deviation(mean_, *kidnap_watch_.elsewhere());
    covariance_ += away * away.transpose();
  }
  effective_particles_ = particles_.effective_number();
  const Outcome& best = outcomes[particles_.best()];
  const bool is_mapped = best.walls.mapped > kMinMappedShare * best.walls.beams;
  wall_agreement_ = is_mapped ? best.walls.agreeing / best.walls.mapped : 1.0;
  markers_told_ = best.known_markers > 0;
}

/// What cannot be mapped where the robot seems to be is not drawn again either.
void WaymarkEstimator::remember(const Observation& observation) {
  const bool is_mapped = verdict_ != KidnapWatch::Verdict::kDoubtful;
  retrospect_.add_update(belief().pose_by_statics(kStaticMarkers), statics(),
                         is_mapped ? observation : Observation{}, mean_);
}

}  // namespace waymark

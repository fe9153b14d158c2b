// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/waymark.hpp"

#include "slam/core/belief/told_axes.hpp"
#include "slam/core/filter/centred_normals.hpp"
#include "slam/core/landmark/misreading.hpp"

#include <algorithm>

namespace waymark {
namespace {

// Cosine: markers that are seen more from the side may be missed.
constexpr double kMinFacing = 0.3;
constexpr double kWallInSight_m = 0.2;                      // a beam ends this near to the marker
constexpr Duration kSightingAge = std::chrono::seconds{1};  // a marker seen since is in view
constexpr std::size_t kStaticMarkers = 4;                   // that a past pose is corrected by
constexpr double kExact = 1e-14;                            // [m^2, rad^2] less is rounding
constexpr double kMinSurfaces = 0.1;     // share of beams; a scan with fewer shows nothing
constexpr double kMinMappedShare = 0.2;  // of a scan's beams; fewer say nothing about being lost

PoseAxes whole_pose() {
  return Eigen::Matrix3d::Identity();
}

}  // namespace

WaymarkEstimator::WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config)
    : setup_{setup},
      config_{config},
      particles_{static_cast<std::size_t>(config.particles),
                 State{GridFrame::centred_on_map_origin(setup.grid.resolution_m),
                       BeliefPrior{config.odometry, setup.sighting_sigmas.learnt}}},
      mapper_{setup.grid} {
  config_.matching.range_sigma_m = setup.range_sigma_m;
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
  const Estimate now = estimate(observation);
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
  setup_.parallel_for(particles_.size(), [&](std::size_t i) {
    outcomes[i] = advance(particles_.state(i), sensed, chances[i]);
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
  drift_.move(expected.map_from_base());
  sensed.drift = drift_.release(observation.beams, sensed.walls, expected.errors_covariance());
  sensed.slip = find_slip(expected, sensed);
  slipped_ = sensed.slip.has_value();
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

WaymarkEstimator::Outcome WaymarkEstimator::advance(State& state, const Sensed& sensed,
                                                    const Chance& chance) const {
  Outcome outcome;
  const bool is_doubtful = sensed.verdict == KidnapWatch::Verdict::kDoubtful;
  state.previous_map_from_base = state.map_from_base;
  if (updates_ > 0) follow(state, sensed, chance, outcome);
  if (!config_.markers_in_proposal) draw(state, sensed, whole_pose(), chance, outcome);
  if (!is_doubtful) {
    correct_by_markers(state, sensed, outcome);
    note_absences(state, sensed);
  }
  if (config_.markers_in_proposal && !sensed.observation->beams.empty())
    draw(state, sensed, told_axes(sensed.walls, state.belief), chance, outcome);
  state.map_from_base = state.belief.map_from_base();
  if (is_doubtful) return outcome;
  outcome.log_evidence += config_.id_layer_evidence *
                          marker_score(mapper_.map(), sensed.spots, state.map_from_base, {});
  for (const AnnotatedBeam& annotated : sensed.observation->beams) {
    const Eigen::Vector2d end = state.map_from_base * annotated.beam.end_in_base;
    if (!drift_.is_better_known(end)) state.walls.add(end);
  }
  return outcome;
}

/// By odometry and walls.
void WaymarkEstimator::follow(State& state, const Sensed& sensed, const Chance& chance,
                              Outcome& outcome) const {
  if (!sensed.walls.is_degenerate) draw_rest(state, sensed, chance);
  const Eigen::Matrix3d left = state.belief.pose_covariance();
  const Eigen::Vector2d from = state.belief.map_from_base().translation();
  move(state, sensed);
  const Eigen::Vector2d step = state.belief.map_from_base().translation() - from;
  state.belief.widen(sensed.drift.since);
  if (sensed.slip) state.belief.widen(slip_error(*sensed.slip));
  const Se2 predicted_from_map = state.belief.map_from_base().inverse();
  const Eigen::Matrix3d prior = turned(predicted_from_map, state.belief.pose_covariance());
  correct_by_walls(state, sensed, carried_along(left, step), chance.start, outcome);
  const Eigen::Matrix3d posterior = turned(predicted_from_map, state.belief.pose_covariance());
  const Se2 moved = predicted_from_map * state.belief.map_from_base();
  outcome.correction = {
      {moved.x(), moved.y(), moved.theta()}, prior.diagonal(), posterior.diagonal()};
  if (sensed.slip) return;  // walls tell all of it
  state.belief.slip(since_update_,
                    slip_watch_.slipped_turn(outcome.correction, since_update_, config_.odometry));
}

void WaymarkEstimator::draw(State& state, const Sensed& sensed, const PoseAxes& axes,
                            const Chance& chance, Outcome& outcome) const {
  const PoseError before = state.belief.pose_error();
  state.belief.draw_pose(axes, chance.pose);
  const PoseError after = state.belief.pose_error();
  outcome.drawn = {before.covariance - after.covariance, before.by_errors - after.by_errors};
  if (!sensed.walls.is_degenerate) return;
  const Eigen::Matrix3d told =
      without(state.belief.map_from_base().rotation() * sensed.walls.weak_direction);
  outcome.by_noise = told * outcome.by_noise * told;
}

/// What earlier scans have left open of the pose that they were mapped from.
void WaymarkEstimator::draw_rest(State& state, const Sensed& sensed, const Chance& chance) const {
  const Eigen::Vector2d weak = state.map_from_base.rotation() * sensed.walls.weak_direction;
  state.belief.draw_pose(Eigen::Vector3d{weak.x(), weak.y(), 0.0}, chance.rest);
}

/// By odometry, or to where the markers say that the robot has been carried.
void WaymarkEstimator::move(State& state, const Sensed& sensed) const {
  state.belief.move(since_update_, noise_);
  if (sensed.verdict == KidnapWatch::Verdict::kBack) {
    state.belief.relocate(kidnap_watch_.returning_pose());
  } else if (sensed.verdict == KidnapWatch::Verdict::kElsewhere) {
    const MarkerMeasurement& by = kidnap_watch_.relocating_marker();
    if (const auto marker = state.belief.witness(by.id)) state.belief.relocate(*marker, by);
  }
}

/// Absence is evidence where the camera could have seen the marker, and nothing stood before it:
/// the LiDAR sees its wall.
void WaymarkEstimator::note_absences(State& state, const Sensed& sensed) const {
  const Observation& observation = *sensed.observation;
  if (!observation.camera_reported) return;
  const auto is_in_view = [&](const Se2& base_from_marker) {
    const Eigen::Vector2d place = base_from_marker.translation();
    const Eigen::Vector2d to_camera =
        (setup_.camera.base_from_camera.translation() - place).normalized();
    const Eigen::Vector2d facing = base_from_marker.rotation().col(0);
    return facing.dot(to_camera) > kMinFacing && setup_.camera.would_show(place) &&
           std::any_of(observation.beams.begin(), observation.beams.end(),
                       [&](const AnnotatedBeam& annotated) {
                         return (annotated.beam.end_in_base - place).norm() < kWallInSight_m;
                       });
  };
  state.belief.note_absences(is_in_view, observation.time - kSightingAge);
}

/// @param open  covariance of the pose that earlier updates have left, carried along by the motion.
/// @param match  out: of the last step.
PoseProposal WaymarkEstimator::match_walls(const State& state, const Belief& belief,
                                           const Sensed& sensed, const Eigen::Matrix3d& open,
                                           const Se2& start, SurfaceMatch& match) const {
  const std::vector<AnnotatedBeam>& beams = sensed.observation->beams;
  SurfaceFinder walls{state.walls, beams.size()};
  // The scan as a whole is off from the pose, for it was measured while the robot moved.
  const MeanSweep& sweep = sensed.observation->mean_sweep;
  const Eigen::Matrix3d by_sweep =
      turned(belief.map_from_base(), random_walk(sweep.distance_m, sweep.turn_rad, noise_));
  return propose(
      belief.map_from_base(), belief.pose_covariance(),
      [&](const Se2& pose, const Eigen::Matrix3d& uncertainty) {
        match = match_surfaces(beams, walls, pose, uncertainty + sensed.drift.before + by_sweep,
                               config_.matching);
        if (sensed.walls.is_degenerate) remove_weak_direction(open, match.pose);
        match.pose = blurred(match.pose, by_sweep);
        return blurred(match.pose, sensed.drift.before);
      },
      start);
}

/// Matching begins at headings as the particles may have them: where the wheels slip in a turn,
/// scans fit among clutter in more than one way, and from the expected heading alone all particles
/// would find the same one.
void WaymarkEstimator::correct_by_walls(State& state, const Sensed& sensed,
                                        const Eigen::Matrix3d& open, double start,
                                        Outcome& outcome) const {
  const Se2 expected = state.belief.map_from_base();
  const Eigen::Matrix3d prior = state.belief.pose_covariance();
  const Eigen::Vector3d from =
      sensed.slip.value_or(Eigen::Vector3d{0.0, 0.0, start * std::sqrt(prior(2, 2))});
  const PoseProposal by_walls =
      match_walls(state, state.belief, sensed, open, deviated(expected, from), outcome.walls);
  state.belief.correct_pose(by_walls.mean, by_walls.covariance);
  const Eigen::Matrix3d followed =
      by_walls.covariance * share_left(outcome.walls.pose, sensed.drift.before);
  outcome.by_noise = followed * outcome.walls.pose.information * followed.transpose();
  outcome.log_evidence += config_.scan_evidence * by_walls.log_evidence;
}

void WaymarkEstimator::correct_by_markers(State& state, const Sensed& sensed,
                                          Outcome& outcome) const {
  const Eigen::Matrix3d before = state.belief.pose_covariance();
  for (const MarkerMeasurement& measurement : sensed.markers) {
    if (measurement.wall) state.belief.correct_sighting_errors(*measurement.wall);
    if (measurement.focal) state.belief.correct_sighting_errors(*measurement.focal);
    const auto nearest = state.belief.nearest(measurement);
    if (nearest && nearest->may_be_it(config_.marker_gate, config_.marker_near_m)) {
      outcome.log_evidence +=
          config_.marker_evidence *
          state.belief.correct(nearest->marker, measurement, config_.marker_gate);
      ++outcome.known_markers;
    } else {
      outcome.log_evidence -= config_.marker_evidence * 0.5 * config_.marker_gate;
      const bool is_elsewhere = !nearest || nearest->distance_m() > config_.same_marker_within_m;
      if (is_elsewhere &&
          !is_misread(measurement, state.belief.map_from_base(), state.belief.markers()))
        state.belief.add(measurement);
    }
  }
  // What markers tell comes with noise of its own: Joseph's form of the update.
  const Eigen::Matrix3d after = state.belief.pose_covariance();
  const Eigen::Matrix3d exact = kExact * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d kept = (before + exact).ldlt().solve(after + exact).transpose();
  outcome.by_noise = after - kept * (before - outcome.by_noise) * kept.transpose();
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

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/waymark_particle.hpp"

#include "slam/core/belief/told_axes.hpp"
#include "slam/core/landmark/misreading.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Cosine: markers that are seen more from the side may be missed.
constexpr double kMinFacing = 0.3;
constexpr double kWallInSight_m = 0.2;                      // a beam ends this near to the marker
constexpr Duration kSightingAge = std::chrono::seconds{1};  // a marker seen since is in view
constexpr double kExact = 1e-14;                            // [m^2, rad^2] less is rounding

PoseAxes whole_pose() {
  return Eigen::Matrix3d::Identity();
}

}  // namespace

PoseError slip_error(const Eigen::Vector3d& slip) {
  const double squared_m2 = slip.head<2>().squaredNorm();
  const Eigen::Vector3d variances{squared_m2, squared_m2, slip.z() * slip.z()};
  return {variances.asDiagonal(), PoseByErrors::Zero()};
}

ParticleUpdate::Outcome ParticleUpdate::advance(WaymarkParticle& particle,
                                                const Chance& chance) const {
  Outcome outcome;
  const bool is_doubtful = sensed_.verdict == KidnapWatch::Verdict::kDoubtful;
  particle.previous_map_from_base = particle.map_from_base;
  if (!sensed_.is_first) follow(particle, chance, outcome);
  if (!config_.markers_in_proposal) draw(particle.belief, whole_pose(), chance, outcome);
  if (!is_doubtful) {
    correct_by_markers(particle.belief, outcome);
    note_absences(particle.belief);
  }
  if (config_.markers_in_proposal && !sensed_.observation->beams.empty())
    draw(particle.belief, told_axes(sensed_.walls, particle.belief), chance, outcome);
  particle.map_from_base = particle.belief.map_from_base();
  if (is_doubtful) return outcome;
  outcome.log_evidence += config_.id_layer_evidence *
                          marker_score(shared_.map, sensed_.spots, particle.map_from_base, {});
  for (const AnnotatedBeam& annotated : sensed_.observation->beams) {
    const Eigen::Vector2d end = particle.map_from_base * annotated.beam.end_in_base;
    if (!shared_.drift.is_better_known(end)) particle.walls.add(end);
  }
  return outcome;
}

/// By odometry and walls.
void ParticleUpdate::follow(WaymarkParticle& particle, const Chance& chance,
                            Outcome& outcome) const {
  Belief& belief = particle.belief;
  if (!sensed_.walls.is_degenerate) draw_rest(particle, chance);
  const Eigen::Matrix3d left = belief.pose_covariance();
  const Eigen::Vector2d from = belief.map_from_base().translation();
  move(belief);
  const Eigen::Vector2d step = belief.map_from_base().translation() - from;
  belief.widen(sensed_.drift.since);
  if (sensed_.slip) belief.widen(slip_error(*sensed_.slip));
  const Se2 predicted_from_map = belief.map_from_base().inverse();
  const Eigen::Matrix3d prior = turned(predicted_from_map, belief.pose_covariance());
  correct_by_walls(particle, carried_along(left, step), chance.start, outcome);
  const Eigen::Matrix3d posterior = turned(predicted_from_map, belief.pose_covariance());
  const Se2 moved = predicted_from_map * belief.map_from_base();
  outcome.correction = {
      {moved.x(), moved.y(), moved.theta()}, prior.diagonal(), posterior.diagonal()};
  if (sensed_.slip) return;  // walls tell all of it
  outcome.slipped_turn_rad =
      shared_.slip_watch.slipped_turn(outcome.correction, sensed_.motion, config_.odometry);
  belief.slip(sensed_.motion, outcome.slipped_turn_rad);
}

void ParticleUpdate::draw(Belief& belief, const PoseAxes& axes, const Chance& chance,
                          Outcome& outcome) const {
  const PoseError before = belief.pose_error();
  belief.draw_pose(axes, chance.pose);
  const PoseError after = belief.pose_error();
  outcome.drawn = {before.covariance - after.covariance, before.by_errors - after.by_errors};
  if (!sensed_.walls.is_degenerate) return;
  const Eigen::Matrix3d told =
      without(belief.map_from_base().rotation() * sensed_.walls.weak_direction);
  outcome.by_noise = told * outcome.by_noise * told;
}

/// What earlier scans have left open of the pose that they were mapped from.
void ParticleUpdate::draw_rest(WaymarkParticle& particle, const Chance& chance) const {
  const Eigen::Vector2d weak = particle.map_from_base.rotation() * sensed_.walls.weak_direction;
  particle.belief.draw_pose(Eigen::Vector3d{weak.x(), weak.y(), 0.0}, chance.rest);
}

/// By odometry, or to where the markers say that the robot has been carried.
void ParticleUpdate::move(Belief& belief) const {
  belief.move(sensed_.motion, sensed_.noise);
  if (sensed_.verdict == KidnapWatch::Verdict::kBack) {
    belief.relocate(*sensed_.returning_pose);
  } else if (sensed_.verdict == KidnapWatch::Verdict::kElsewhere) {
    const MarkerMeasurement& by = *sensed_.relocating_marker;
    if (const auto marker = belief.witness(by.id)) belief.relocate(*marker, by);
  }
}

/// Absence is evidence where the camera could have seen the marker, and nothing stood before it:
/// the LiDAR sees its wall.
void ParticleUpdate::note_absences(Belief& belief) const {
  const Observation& observation = *sensed_.observation;
  if (!observation.camera_reported) return;
  const auto is_in_view = [&](const Se2& base_from_marker) {
    const Eigen::Vector2d place = base_from_marker.translation();
    const Eigen::Vector2d to_camera =
        (shared_.camera.base_from_camera.translation() - place).normalized();
    const Eigen::Vector2d facing = base_from_marker.rotation().col(0);
    return facing.dot(to_camera) > kMinFacing && shared_.camera.would_show(place) &&
           std::any_of(observation.beams.begin(), observation.beams.end(),
                       [&](const AnnotatedBeam& annotated) {
                         return (annotated.beam.end_in_base - place).norm() < kWallInSight_m;
                       });
  };
  belief.note_absences(is_in_view, observation.time - kSightingAge);
}

PoseProposal ParticleUpdate::match_walls(const WaymarkParticle& particle, const Belief& belief,
                                         const Eigen::Matrix3d& open, const Se2& start,
                                         SurfaceMatch& match) const {
  const std::vector<AnnotatedBeam>& beams = sensed_.observation->beams;
  SurfaceFinder walls{particle.walls, beams.size()};
  // The scan as a whole is off from the pose, for it was measured while the robot moved.
  const MeanSweep& sweep = sensed_.observation->mean_sweep;
  const Eigen::Matrix3d by_sweep =
      turned(belief.map_from_base(), random_walk(sweep.distance_m, sweep.turn_rad, sensed_.noise));
  return propose(
      belief.map_from_base(), belief.pose_covariance(),
      [&](const Se2& pose, const Eigen::Matrix3d& uncertainty) {
        match = match_surfaces(beams, walls, pose, uncertainty + sensed_.drift.before + by_sweep,
                               config_.matching);
        if (sensed_.walls.is_degenerate) remove_weak_direction(open, match.pose);
        match.pose = blurred(match.pose, by_sweep);
        return blurred(match.pose, sensed_.drift.before);
      },
      start);
}

/// Matching begins at headings as the particles may have them: where the wheels slip in a turn,
/// scans fit among clutter in more than one way, and from the expected heading alone all particles
/// would find the same one.
void ParticleUpdate::correct_by_walls(WaymarkParticle& particle, const Eigen::Matrix3d& open,
                                      double start, Outcome& outcome) const {
  Belief& belief = particle.belief;
  const Se2 expected = belief.map_from_base();
  const Eigen::Matrix3d prior = belief.pose_covariance();
  const Eigen::Vector3d from =
      sensed_.slip.value_or(Eigen::Vector3d{0.0, 0.0, start * std::sqrt(prior(2, 2))});
  const PoseProposal by_walls =
      match_walls(particle, belief, open, deviated(expected, from), outcome.walls);
  belief.correct_pose(by_walls.mean, by_walls.covariance);
  const Eigen::Matrix3d followed =
      by_walls.covariance * share_left(outcome.walls.pose, sensed_.drift.before);
  outcome.by_noise = followed * outcome.walls.pose.information * followed.transpose();
  outcome.log_evidence += config_.scan_evidence * by_walls.log_evidence;
}

void ParticleUpdate::correct_by_markers(Belief& belief, Outcome& outcome) const {
  const Eigen::Matrix3d before = belief.pose_covariance();
  for (const MarkerMeasurement& measurement : sensed_.markers) {
    if (measurement.wall) belief.correct_sighting_errors(*measurement.wall);
    if (measurement.focal) belief.correct_sighting_errors(*measurement.focal);
    const auto nearest = belief.nearest(measurement);
    if (nearest && nearest->may_be_it(config_.marker_gate, config_.marker_near_m)) {
      outcome.log_evidence += config_.marker_evidence *
                              belief.correct(nearest->marker, measurement, config_.marker_gate);
      ++outcome.known_markers;
    } else {
      outcome.log_evidence -= config_.marker_evidence * 0.5 * config_.marker_gate;
      const bool is_elsewhere = !nearest || nearest->distance_m() > config_.same_marker_within_m;
      if (is_elsewhere && !is_misread(measurement, belief.map_from_base(), belief.markers()))
        belief.add(measurement);
    }
  }
  // What markers tell comes with noise of its own: Joseph's form of the update.
  const Eigen::Matrix3d after = belief.pose_covariance();
  const Eigen::Matrix3d exact = kExact * Eigen::Matrix3d::Identity();
  const Eigen::Matrix3d kept = (before + exact).ldlt().solve(after + exact).transpose();
  outcome.by_noise = after - kept * (before - outcome.by_noise) * kept.transpose();
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator initialises, takes a commanded pose, and relocalises.
#include "slam/core/estimators/waymark.hpp"

namespace waymark {
namespace {

constexpr double kFound_m = 0.1;  // sigmas of a pose from global localisation
constexpr double kFound_rad = 0.05;
constexpr double kRelocated_m = 0.3;  // sigmas of the pose after a relocalisation, or its revert
constexpr double kRelocated_rad = 0.1;

Se2 map_from_base_at(const StartPose& pose) {
  return {pose.x_m, pose.y_m, pose.yaw_rad};
}

PosePrior pose_prior(std::size_t keyframe, const Se2& map_from_base, double sigma_m,
                     double sigma_rad) {
  const Eigen::Vector3d sigmas{sigma_m, sigma_m, sigma_rad};
  return {keyframe, map_from_base, sigmas.cwiseInverse().asDiagonal()};
}

PlaceTrust trust_in(const StartPose& pose) {
  return pose.is_certain ? PlaceTrust::kKnown : PlaceTrust::kAssumed;
}

}  // namespace

void WaymarkEstimator::add_first_keyframe() {
  is_pose_reset_ = true;
  const Se2 map_from_base = map_from_base_at(start_);
  graph_.add_keyframe(map_from_base);
  graph_.add(loaded_map_ ? pose_prior(0, map_from_base, start_.sigma_m, start_.sigma_rad)
                         : pose_prior(0, map_from_base, kFirstPoseSigma, kFirstPoseSigma));
}

bool WaymarkEstimator::set_pose(const StartPose& pose) {
  if (!has_map_frame()) return false;
  const bool has_begun = !graph_.state().keyframes.empty();
  if (!has_begun && !loaded_map_) return false;  // there is no map that it could be in
  const Eigen::Vector2d given{pose.x_m, pose.y_m};
  Eigen::Vector2d known = given;
  if (has_begun)
    known = graph_.state().keyframes.back().translation();
  else if (!loaded_map_->wall_points().empty())
    known = loaded_map_->wall_points().front();
  if ((given - known).norm() > farthest_pose_m(setup_.grid.resolution_m)) return false;
  if (has_begun)
    commanded_pose_ = pose;
  else
    start_ = pose;
  if (place_finder_) loaded_map_->trust(trust_in(pose));
  place_finder_.reset();
  note_reason(pose.kind == StartKind::kLast ? EstimateReason::kRelocalised
                                            : EstimateReason::kCommand);
  return true;
}

/// Adds a keyframe at a commanded pose, without odometry from the previous keyframe.
void WaymarkEstimator::add_keyframe_at_commanded_pose(const StartPose& pose) {
  const Se2 map_from_base = map_from_base_at(pose);
  const std::size_t keyframe = graph_.add_keyframe(map_from_base);
  graph_.add(OdometryFactor{.from = keyframe - 1, .to = keyframe, .is_disabled = true});
  graph_.add(pose_prior(keyframe, map_from_base, pose.sigma_m, pose.sigma_rad));
  if (loaded_map_) {
    loaded_map_->trust(trust_in(pose));
    loaded_map_->forget_votes();
  }
  note_pose_given();
  begin_submaps_anew();
}

/// To be called after a command or a new map frame has changed the pose. (After a relocalisation
/// the standstill is kept instead, since odometry may have been stuck.)
void WaymarkEstimator::note_pose_given() {
  is_pose_reset_ = true;
  relocalisation_ = {};
  note_pose_known();
  standstill_.reset();
  keyframes_standing_ = 0;
  unmeasured_motion_.note_observed();
}

/// @return whether the robot's pose in the loaded map is known now.
bool WaymarkEstimator::try_global_localisation(const Observation& observation) {
  const auto found = place_finder_->update(observation.motion, observation, measured(observation),
                                           setup_.camera, registration_.range_noise());
  if (!found) return false;
  start_ = {StartKind::kPose, found->x(), found->y(), found->theta(), kFound_m, kFound_rad};
  place_finder_.reset();
  loaded_map_->trust(PlaceTrust::kKnown);
  motion_ = {};
  note_reason(EstimateReason::kRelocalised);
  return true;
}

Estimate WaymarkEstimator::estimate_without_pose(const Observation& observation) const {
  Estimate estimate = describe_observation(observation, {}, setup_.range_sigma_m);
  estimate.has_pose = false;
  estimate.health = Health::kInitialising;
  return estimate;
}

/// A robot that was carried has driven along a path of unknown place: that path is moved as a
/// whole. Otherwise a prior takes the place of the odometry factor, which holds no longer: without
/// it, the robust weights of markers that are metres away from where the solver begins would be
/// next to nothing.
void WaymarkEstimator::relocate(const Se2& map_from_base) {
  ++statistics_.relocalisations;
  const bool has_path = carried_ && !is_map_fixed();
  if (has_path)
    graph_.move_since(carried_->keyframe, carried_->num_landmarks,
                      map_from_base * graph_.state().keyframes.back().inverse());
  else
    graph_.relocate_newest(map_from_base);
  graph_.add(pose_prior(newest(), map_from_base, kRelocated_m, kRelocated_rad));
  if (has_path) {
    graph_.step_all();
    map_.redraw_all(poses_of(graph_));
  } else {
    graph_.optimise();
    begin_submaps_anew();
  }
  is_pose_reset_ = true;
  note_pose_known();
}

/// A scan that observes all axes at the predicted pose shows that nobody has carried the robot; one
/// that contradicts the map, that somebody has.
void WaymarkEstimator::note_scan_after_standstill(const ScanAtPrediction& scan,
                                                  const KeyframeScan& used) {
  const bool contradicts = scan.matched && inlier_share_ < config_.lost_inlier_share;
  if (carried_) {
    carried_->driven_m += motion_.distance_m;
    if (fits_walls_before_carry(scan.points)) note_pose_known();
  } else if (may_be_carried_since_ && contradicts) {
    carried_ = Carried{newest(), graph_.state().landmarks.size(), scan.matched->ndt(),
                       scan.matched->map_from_submap};
    begin_submaps_anew();
  } else if (used.observes_all_axes && !scan.was_searched_widely) {
    note_pose_known();
  }
}

bool WaymarkEstimator::fits_walls_before_carry(const Points& points) const {
  const SubmapPrediction guess = in_submap(
      {graph_.state().keyframes.back(), graph_.covariance_of({VariableKind::kKeyframe, newest()})},
      carried_->map_from_walls);
  const ScanMatch match = match_scan(points, carried_->walls, guess.submap_from_base,
                                     guess.covariance, registration_.range_noise(), config_.scan);
  const UsualFit& usual = registration_.usual_fit();
  return usual.is_nearly_usual(match) && usual.is_as_usual_where_mapped(match);
}

void WaymarkEstimator::note_pose_known() {
  may_be_carried_since_.reset();
  carried_.reset();
}

void WaymarkEstimator::begin_submaps_anew() {
  submaps_.begin_anew();
  loop_finder_.reset();
}

}  // namespace waymark

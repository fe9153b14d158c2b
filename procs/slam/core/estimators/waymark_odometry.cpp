// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses odometry, and learns its noise.
#include "slam/core/estimators/waymark.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kLift_s = 0.5;  // standing still: less is too short for a robot to be carried off
constexpr double kOtherNoise = 2.0;  // ratio of variances beyond which the whole graph takes a step
constexpr std::size_t kReweighEvery = 10;  // keyframes

double along_m2_per_m(const OdometryNoise& noise) {
  return noise.along_per_sqrt_m * noise.along_per_sqrt_m;
}

bool differs_clearly(double a, double b) {
  return a > kOtherNoise * b || b > kOtherNoise * a;
}

}  // namespace

/// Late motion of odometry that was stuck begins at the keyframe where it got stuck. Later
/// keyframes, which markers or walls have triggered, lose their odometry factors.
void WaymarkEstimator::follow_odometry(const Observation& observation) {
  unmeasured_motion_.follow(observation);
  if (observation.odometry_caught_up) ++statistics_.odometry_caught_up;
  if (observation.odometry_caught_up && standstill_) {
    const std::size_t start = standstill_->keyframe();
    graph_.disable_odometry_since(start);
    submaps_.freeze_shapes();
    const bool is_in_graph = !is_map_fixed() && !graph_.is_removed(start);
    if (is_in_graph || graph_.is_active({VariableKind::kKeyframe, start})) {
      moved_from_ = start;
      motion_ = standstill_->motion();
    } else {
      motion_ = {};
      motion_.start_from_end =
          graph_.state().keyframes.back().inverse() * standstill_->map_from_start();
    }
    spread_late_motion(observation);
  }
  motion_ = motion_.then(odometry_check_.plausible(observation.motion, observation.elapsed_s,
                                                   observation.odometry_caught_up));
  if (!unmeasured_motion_.is_standing()) {
    standstill_.reset();
    keyframes_standing_ = 0;
  } else if (!standstill_ && !graph_.state().keyframes.empty()) {
    const Se2 here = graph_.state().keyframes.back() * newest_from_last_scan_ *
                     observation.motion.start_from_end;
    standstill_.emplace(moved_from_, motion_, here, clock_s_);
  }
  const bool may_be_carried = (standstill_ && clock_s_ - standstill_->since_s() >= kLift_s) ||
                              odometry_check_.is_refused() || observation.odometry_jumped ||
                              observation.odometry_caught_up || observation.clock_set != Duration{};
  if (may_be_carried && !may_be_carried_since_) may_be_carried_since_ = observation.time;
  ++statistics_.observations;
  if (observation.odometry_jumped || odometry_check_.is_refused()) {
    ++statistics_.odometry_jumping;
  } else if (unmeasured_motion_.is_unreliable()) {
    ++statistics_.odometry_stuck;
  }
}

bool WaymarkEstimator::is_keyframe_due(const Observation& observation) const {
  if (graph_.state().keyframes.empty()) return true;
  const bool is_seen = !observation.sightings.empty();
  if (is_seen && unmeasured_motion_.is_unreliable() && keyframes_standing_ < kMaxStanding)
    return true;
  return motion_.start_from_end.translation().norm() >=
             (is_seen ? config_.marker_keyframe_distance_m : config_.keyframe_distance_m) ||
         std::abs(motion_.start_from_end.theta()) >= config_.keyframe_turn_rad;
}

/// Whether the estimate has moved by the distance or turn of a keyframe while odometry is
/// unreliable.
bool WaymarkEstimator::has_moved_without_odometry(const Se2& map_from_base) const {
  if (!unmeasured_motion_.is_unreliable()) return false;
  const Eigen::Vector3d moved = pose_difference(map_from_base, graph_.state().keyframes.back());
  return moved.head<2>().norm() >= config_.keyframe_distance_m ||
         std::abs(moved.z()) >= config_.keyframe_turn_rad;
}

Prediction WaymarkEstimator::prediction() const {
  const CorrectedMotion moved = with_slips(
      corrected_motion(motion_, odometry_part(graph_.state().calibration), graph_.odometry_noise()),
      motion_.distance_m, hidden_slips_, graph_.noise().learnt_odometry);
  const Eigen::Matrix3d covariance =
      moved.covariance + unmeasured_covariance(unmeasured_motion_.unmeasured_m());
  const Se2& from = graph_.state().keyframes[moved_from_];
  return {from * moved.start_from_end, in_axes(from.rotation(), covariance)};
}

/// Share of the slips since the keyframe moved_from_ that known markers do not observe.
double WaymarkEstimator::hidden_slips(std::span<const MarkerMeasurement> measurements) const {
  std::vector<Eigen::Matrix2d> places;
  for (const MarkerMeasurement& measured : measurements)
    if (book_.knows(measured.id)) places.emplace_back(measured.covariance.topLeftCorner<2, 2>());
  return hidden_share(motion_, places, graph_.noise().learnt_odometry);
}

void WaymarkEstimator::add_odometry_factor(std::size_t keyframe) {
  OdometryFactor odometry;
  odometry.hidden_slips = hidden_slips_;
  odometry.from = moved_from_;
  odometry.to = keyframe;
  odometry.motion = motion_;
  odometry.unmeasured_m = unmeasured_motion_.take_unmeasured_m();
  graph_.add(odometry);
  // If the keyframe at which odometry got stuck has left the window, only a step of the whole graph
  // uses the factor.
  if (!graph_.is_active({VariableKind::kKeyframe, moved_from_})) step_whole_graph({});
}

/// Detects that odometry is stuck, and counts keyframes while the robot seems to stand.
void WaymarkEstimator::compare_with_odometry() {
  if (!standstill_) return;
  ++keyframes_standing_;
  const auto moved = standstill_->compare(graph_.state().keyframes.back(), clock_s_);
  if (!moved) return;
  keyframes_standing_ = 0;
  if (moved->has_returned)
    unmeasured_motion_.note_returned();
  else
    unmeasured_motion_.note_moved(moved->distance_m, moved->elapsed_s);
}

/// Corrects the final trajectory for a standstill during which odometry was stuck.
void WaymarkEstimator::spread_late_motion(const Observation& observation) {
  const ScanPose start{observation.time, standstill_->keyframe(),
                       standstill_->motion().start_from_end, standstill_->since_s()};
  const ScanPose end{observation.time, start.keyframe,
                     start.keyframe_from_base * observation.motion.start_from_end, clock_s_};
  scan_poses_.spread_motion(start, end, graph_.state().keyframes);
}

/// Learns from the innovation of a scan: matched minus predicted pose, in the base frame.
void WaymarkEstimator::learn_noise(const Prediction& expected, const MatchedScan& scan) {
  if (!config_.learn_noise || motion_.guessed_s > 0.0 || unmeasured_motion_.is_standing() ||
      unmeasured_motion_.is_unreliable()) {
    return;
  }
  const OdometryNoise& described = graph_.noise().odometry;
  const ScanMatch& match = scan.match;
  const Se2 found = scan.map_from_base();
  const Eigen::Matrix2d to_base = found.rotation().transpose();
  Eigen::Vector3d off = pose_difference(found, expected.map_from_base);
  off.head<2>() = (to_base * off.head<2>()).eval();
  const Eigen::Matrix3d information =
      in_axes(match.map_from_base.rotation().transpose(), match.observed.information);
  // Variances of two scans: this one and the previous one.
  noise_learner_.observe_turn({off.z(),
                               turn_variance(described, motion_.distance_m, motion_.turn_rad),
                               2.0 / information(2, 2), motion_.distance_m});
  if (!match.observed.is_degenerate) {
    const Eigen::Matrix3d covariance = information.inverse();
    noise_learner_.observe_along({off.x(), along_m2_per_m(described) * motion_.distance_m,
                                  2.0 * covariance(0, 0), motion_.distance_m});
  }
  graph_.set_learnt_odometry_noise(noise_learner_.learnt_noise());
}

/// Learns from the innovation of a known marker, if nothing has observed the motion along the path
/// since the last known marker.
void WaymarkEstimator::learn_noise(const MarkerInnovation& innovation,
                                   const MarkerMeasurement& measurement) {
  if (!config_.learn_noise || unobserved_m_ <= 0.0 || unmeasured_motion_.is_unreliable()) return;
  const double configured_m2 = along_m2_per_m(graph_.noise().odometry) * unobserved_m_;
  const double blind_m = std::max(0.0, unobserved_m_ - motion_.distance_m);
  const double learnt_m2 = along_m2_per_m(graph_.odometry_noise()) * unobserved_m_ +
                           graph_.noise().learnt_odometry.slip_m2_per_m * blind_m;
  // If the marker is further ahead than expected, the robot has driven less.
  const OdometryInnovation along{
      -innovation.residual.x(), configured_m2,
      std::max(innovation.covariance(0, 0) - learnt_m2, measurement.covariance(0, 0)),
      unobserved_m_};
  noise_learner_.observe_slip(along);
  noise_learner_.observe_along(along);
  graph_.set_learnt_odometry_noise(noise_learner_.learnt_noise());
}

/// Takes a step of the whole graph when the learnt noise has changed, to reweight old factors.
void WaymarkEstimator::reweigh_old_factors() {
  const OdometryNoise noise = graph_.odometry_noise();
  const bool is_other_noise =
      differs_clearly(along_m2_per_m(noise), along_m2_per_m(noise_of_old_factors_)) ||
      differs_clearly(
          noise.turn_per_sqrt_m * noise.turn_per_sqrt_m,
          noise_of_old_factors_.turn_per_sqrt_m * noise_of_old_factors_.turn_per_sqrt_m);
  const std::size_t all = graph_.state().keyframes.size();
  if (is_map_fixed() || !is_other_noise || solve_schedule_.num_since_solution(all) < kReweighEvery)
    return;
  noise_of_old_factors_ = noise;
  step_whole_graph({});
}

}  // namespace waymark

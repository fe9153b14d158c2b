// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/waymark.hpp"

#include "common/geometry/squared.hpp"
#include "slam/core/localisation/map_fit.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

constexpr double kFixed = 1e-6;  // factor on the prior sigmas of a calibration that is not learnt

// A scan that contradicts odometry becomes a keyframe, so that the graph chooses the component of
// the odometry's noise.
constexpr double kContradiction = 25.0;  // chi^2
constexpr double kContradiction_m = 0.03;
constexpr double kContradiction_rad = 0.02;

// Standard deviations from scan to scan while odometry stands still, since it may be stuck.
const Eigen::Vector3d kStuckStep{0.1, 0.1, 0.05};

constexpr double kCarried_m = 5.0;  // standard deviation of the distance that a robot is carried

/// Variances of (x, y, theta) of a robot that was carried, and has driven since: any heading.
Eigen::Vector3d unknown_pose_variances(double driven_m) {
  const double place_m2 = squared(kCarried_m) + squared(driven_m);
  return {place_m2, place_m2, squared(std::numbers::pi) / 3.0};
}

GraphNoise graph_noise(const EstimatorSetup& setup, const WaymarkConfig& config) {
  GraphNoise noise;
  noise.odometry = config.odometry;
  noise.odometry.half_track_m = setup.half_track_m;
  noise.marker_gate = config.marker_gate;
  return noise;
}

/// The map before this run's first scan.
GridMap base_map_of(const EstimatorSetup& setup) {
  if (setup.loaded_map) return setup.loaded_map->grid;
  return {GridFrame::centred_on_map_origin(setup.grid.resolution_m), {}, {}};
}

}  // namespace

Calibration calibration_sigmas(const EstimatorSetup& setup, const WaymarkConfig& config) {
  const OdometryNoise& odometry = config.odometry;
  Calibration sigmas;
  sigmas << odometry.scale_sigma, odometry.drift_sigma_rad_per_m, odometry.turn_scale_sigma,
      odometry.lidar_ahead_sigma_m, odometry.lidar_yaw_sigma_rad, setup.sighting_noise.calibration;
  return config.calibrate ? sigmas : Calibration{kFixed * sigmas};
}

WaymarkEstimator::WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config)
    : setup_{setup},
      config_{config},
      graph_{graph_noise(setup, config), calibration_sigmas(setup, config)},
      registration_{config, setup.range_sigma_m},
      loop_finder_{config.loops, config.scan},
      thinning_{config.keyframes_per_place, 2 * config.submap_keyframes},
      submaps_{config.scan.cell_spacing_m, config.submap_keyframes, config.submap_length_m},
      map_{setup.grid, base_map_of(setup)},
      noise_of_old_factors_{graph_.odometry_noise()},
      start_{setup.start},
      survey_{setup.loaded_map ? std::vector<SurveyedMarker>{} : setup.survey} {
  if (setup_.loaded_map) load(setup_.loaded_map);
}

Estimate WaymarkEstimator::update(const Observation& measured) {
  newest_time_ = measured.time;
  clock_s_ += measured.elapsed_s;
  if (measured.clock_set != Duration{}) book_.set_clock(measured.clock_set);
  if (may_be_carried_since_) *may_be_carried_since_ += measured.clock_set;
  is_pose_reset_ = false;
  is_observed_ = false;
  solved_.reset();
  follow_odometry(measured);
  if (place_finder_ && !try_global_localisation(measured)) return estimate_without_pose(measured);
  ScanAtPrediction scan = match_at_prediction(measured);
  statistics_.beams += static_cast<std::int64_t>(measured.beams.size());
  statistics_.beams_moving += static_cast<std::int64_t>(scan.beams_moving);
  const std::optional<Observation> corrected =
      registration_.with_right_scale(measured, maps_for_scan(), scan);
  const Observation& observation = corrected ? *corrected : measured;
  bool is_keyframe = commanded_pose_ || odometry_check_.is_refused() ||
                     is_keyframe_due(observation) || is_contradicted_by(observation);
  const Se2 map_from_last = map_from_last_scan();
  BetweenKeyframes between;
  if (!is_keyframe) {
    between = between_keyframes(scan);
    is_keyframe = between.contradicts_odometry || has_moved_without_odometry(between.map_from_base);
  }
  if (is_keyframe) {
    add_keyframe(observation, scan);
    since_insertion_m_ = observation.motion.distance_m;
  } else {
    if (scan.matched) registration_.note_fit(scan.matched->match);
    since_insertion_m_ += observation.motion.distance_m;
    if (between.observes_all_axes || sees_known_markers(observation))
      unmeasured_motion_.note_observed();
    is_observed_ = between.observes_all_axes;
    if (between.match) insert_between(scan.points, *between.match, between.map_from_base);
  }
  if (between.match) note_reason(EstimateReason::kScan);
  Estimate now =
      is_keyframe ? estimate_at_keyframe(observation) : estimate_between(observation, between);
  now.updated = is_keyframe;
  odometry_check_.note_estimated(
      is_pose_reset_ ? Se2{} : map_from_last.inverse() * now.map_from_base, measured.elapsed_s);
  newest_from_last_scan_ = graph_.state().keyframes.back().inverse() * now.map_from_base;
  reason_ = EstimateReason::kOdometry;
  if (!is_map_fixed()) {
    scan_poses_.add({observation.time, newest(), newest_from_last_scan_, clock_s_, is_observed_});
  }
  return has_map_frame() ? now : estimate_without_pose(observation);
}

void WaymarkEstimator::note_reason(EstimateReason reason) {
  reason_ = std::max(reason_, reason);
}

Se2 WaymarkEstimator::map_from_last_scan() const {
  if (graph_.state().keyframes.empty()) return {};
  return graph_.state().keyframes.back() * newest_from_last_scan_;
}

MapsForScan WaymarkEstimator::maps_for_scan() const {
  MapsForScan maps{map_.map()};
  maps.submap = submaps_.current();
  if (maps.submap != nullptr)
    maps.map_from_submap = graph_.state().keyframes[maps.submap->first_keyframe()];
  maps.loaded = loaded_map_ ? &*loaded_map_ : nullptr;
  maps.is_fixed = is_map_fixed();
  return maps;
}

/// The first scan and the one after a commanded pose get neither a prediction nor a match.
ScanAtPrediction WaymarkEstimator::match_at_prediction(const Observation& observation) const {
  ScanAtPrediction scan{points_of(observation)};
  if (graph_.state().keyframes.empty() || commanded_pose_) return scan;
  scan.since_last_s = observation.elapsed_s;
  scan.expected = prediction();
  scan.searched = scan.expected;
  if (unmeasured_motion_.is_standing())
    scan.searched.covariance.diagonal() += kStuckStep.cwiseAbs2();
  scan.map_from_last = map_from_last_scan();
  scan.steps_without_odometry = odometry_check_.steps_without_odometry();
  registration_.match(observation, maps_for_scan(), scan);
  return scan;
}

/// Adds the newest keyframe at its predicted pose, with odometry and scan factor.
WaymarkEstimator::KeyframeScan WaymarkEstimator::add_predicted_keyframe(
    const Observation& observation, std::span<const MarkerMeasurement> measurements,
    ScanAtPrediction& scan) {
  if (scan.matched) registration_.search_widely(observation, maps_for_scan(), scan);
  const auto& matched = scan.matched;
  KeyframeScan used;
  used.is_refuted = matched && registration_.usual_fit().is_refuted(matched->match);
  const bool is_usable = matched && registration_.is_usable(matched->match);
  const bool observes_all_axes = is_usable && !matched->match.observed.is_degenerate;
  // The noise of standing odometry is so small that the solver would keep the predicted pose: the
  // keyframe is initialised at the match instead.
  const bool is_moved = is_usable && unmeasured_motion_.is_standing();
  const std::size_t keyframe =
      graph_.add_keyframe(is_moved ? matched->map_from_base() : scan.expected.map_from_base);
  // A scan that observes all axes measures slips, so odometry keeps its full weight here: with a
  // lower weight, long trajectories become worse, even where sigma along the path is large.
  hidden_slips_ = observes_all_axes ? 0.0 : hidden_slips(measurements);
  add_odometry_factor(keyframe);
  if (matched && matched->match.num_mapped >= config_.scan.min_inliers)
    inlier_share_ = matched->match.inlier_share;
  if (matched) registration_.note_fit(matched->match);
  if (is_usable) {
    note_reason(EstimateReason::kScan);
    learn_noise(scan.expected, *matched);
    used.is_used = add_match_factor(keyframe, *matched);
    used.observes_all_axes = used.is_used && observes_all_axes;
    used.fits_loaded_map = matched->submap == nullptr && used.observes_all_axes &&
                           registration_.is_in_loaded_map(matched->match);
    registration_.note_keyframe(matched->match);
  }
  unobserved_m_ = used.observes_all_axes ? 0.0 : unobserved_m_ + motion_.distance_m;
  return used;
}

/// Relocates the newest keyframe if markers show that the robot was carried, or that the last
/// relocalisation was wrong.
void WaymarkEstimator::check_pose(const Observation& observation,
                                  std::span<const MarkerMeasurement> measurements) {
  const auto compare_walls = [&](const Se2& first, const Se2& second) {
    // The map has walls that were drawn at unknown poses.
    if (carried_) return RelocalisationMonitor::Walls::kUndecided;
    const bool is_first_refuted = fit_in_map(map_.map(), observation.beams, first).is_refuted();
    const bool is_second_refuted = fit_in_map(map_.map(), observation.beams, second).is_refuted();
    if (is_first_refuted == is_second_refuted) return RelocalisationMonitor::Walls::kUndecided;
    return is_first_refuted ? RelocalisationMonitor::Walls::kContradictFirst
                            : RelocalisationMonitor::Walls::kContradictSecond;
  };
  const auto missed = [&](const Se2& map_from_base) {
    return missed_markers(observation, map_from_base);
  };
  verdict_ = relocalisation_.update(graph_.state().keyframes.back(), hints(measurements), motion_,
                                    may_be_carried_since_.has_value(), {compare_walls, missed});
  if (relocalisation_.is_certain()) note_pose_known();
  if (verdict_ == RelocalisationMonitor::Verdict::kRelocated ||
      verdict_ == RelocalisationMonitor::Verdict::kReverted) {
    relocate(relocalisation_.map_from_base());
    note_reason(EstimateReason::kRelocalised);
  }
}

void WaymarkEstimator::add_drift(bool has_scan_factor) {
  const Se2& map_from_base = graph_.state().keyframes.back();
  const Eigen::Matrix3d step = graph_.covariance_of_newest_step();
  drift_.add_keyframe(map_from_base, step);
  unmatched_drift_.add_keyframe(map_from_base, has_scan_factor ? Eigen::Matrix3d::Zero() : step);
}

void WaymarkEstimator::slide_window() {
  while (graph_.num_active_keyframes() > num_window_keyframes())
    graph_.marginalise_oldest(kNear_m);
  if (is_map_fixed()) {
    graph_.add_calibration_random_walk(motion_.distance_m);
    graph_.forget_outside_window();
  } else if (!carried_) {
    remove_redundant_keyframes();
  }
}

void WaymarkEstimator::add_keyframe(const Observation& observation, ScanAtPrediction& scan) {
  inlier_share_ = 1.0;
  KeyframeScan used;
  const std::vector<MarkerMeasurement> measurements = measured(observation);
  if (graph_.state().keyframes.empty())
    add_first_keyframe();
  else if (commanded_pose_)
    add_keyframe_at_commanded_pose(*std::exchange(commanded_pose_, std::nullopt));
  else
    used = add_predicted_keyframe(observation, measurements, scan);
  graph_.optimise();
  note_scan_after_standstill(scan, used);
  check_pose(observation, measurements);
  const bool is_suspicious = is_pose_suspicious();
  markers_known_ = false;
  if (!is_map_fixed()) add_drift(used.is_used);
  if (!is_suspicious) {
    use_markers(measurements);
    note_misses(observation);
    if (!measurements.empty()) use_survey();
    if (config_.loops.enabled && !used.is_refuted && !is_map_fixed() && !carried_)
      close_loops(scan.points);
  }
  reweigh_old_factors();
  compare_with_odometry();
  is_observed_ = markers_known_ || used.observes_all_axes;
  if (is_observed_) unmeasured_motion_.note_observed();
  if (loaded_map_) {
    loaded_map_->compare(observation, graph_.state().keyframes.back(), used.fits_loaded_map,
                         book_.known_markers());
  }
  // A scan whose pose is uncertain is not mapped.
  const bool is_mapped = !is_suspicious && !used.is_refuted && is_confirmed();
  if (loaded_map_ && is_mapped) loaded_map_->add_scan(observation, graph_.state().keyframes.back());
  if (!is_map_fixed())
    map_keyframe(is_mapped ? observation : Observation{}, is_mapped ? scan.points : Points{});
  slide_window();
  motion_ = {};
  moved_from_ = newest();
  if (standstill_ && standstill_->keyframe() == moved_from_) standstill_->note_keyframe_here();
}

void WaymarkEstimator::map_keyframe(const Observation& observation, const Points& points) {
  const Se2& map_from_base = graph_.state().keyframes.back();
  submaps_.rebuild_deformed(graph_.state().keyframes);
  submaps_.add_keyframe(points, graph_.state().keyframes,
                        registration_.range_noise().variance_m2());
  map_.add(observation, map_from_base);
  map_.redraw_some(poses_of(graph_));
}

Estimate WaymarkEstimator::estimate_at_keyframe(const Observation& observation) const {
  return estimate(observation, graph_.state().keyframes.back(),
                  graph_.covariance_of({VariableKind::kKeyframe, newest()}));
}

/// Scans between keyframes reduce the noise of the submaps. A scan that fits worse than usual is
/// left out: its pose may be wrong, and later scans would be matched with it.
void WaymarkEstimator::insert_between(const Points& points, const ScanMatch& match,
                                      const Se2& map_from_base) {
  if (is_map_fixed() || !is_confirmed() || since_insertion_m_ < config_.insert_distance_m ||
      registration_.usual_fit().is_worse_than_usual(match) || is_pose_suspicious()) {
    return;
  }
  since_insertion_m_ = 0.0;
  submaps_.add_between(points, map_from_base, graph_.state().keyframes);
}

WaymarkEstimator::BetweenKeyframes WaymarkEstimator::between_keyframes(
    const ScanAtPrediction& scan) const {
  const Prediction& expected = scan.expected;
  BetweenKeyframes between{expected.map_from_base, expected.covariance};
  const auto& matched = scan.matched;
  if (!matched || !registration_.is_usable(matched->match)) return between;
  const Se2 found = matched->map_from_base();
  const Eigen::Matrix3d information = matched->information();
  const Eigen::Vector3d off = pose_difference(found, expected.map_from_base);
  between.covariance = (expected.covariance.inverse() + information).inverse();
  const Eigen::Vector3d pull = information * off;
  const Eigen::Vector3d step = between.covariance * pull;
  between.map_from_base = moved_by(expected.map_from_base, step);
  between.match = matched->match;
  between.observes_all_axes = !matched->match.observed.is_degenerate;
  const double chi2 = off.dot(pull) - pull.dot(between.covariance * pull);
  between.contradicts_odometry =
      chi2 > kContradiction &&
      (off.head<2>().norm() > kContradiction_m || std::abs(off.z()) > kContradiction_rad);
  return between;
}

Estimate WaymarkEstimator::estimate_between(const Observation& observation,
                                            const BetweenKeyframes& between) const {
  const Eigen::Vector2d lever =
      between.map_from_base.translation() - graph_.state().keyframes.back().translation();
  const Eigen::Matrix3d covariance =
      at_end_of_lever(graph_.covariance_of({VariableKind::kKeyframe, newest()}), lever) +
      between.covariance;
  return estimate(observation, between.map_from_base, covariance);
}

Estimate WaymarkEstimator::estimate(const Observation& observation, const Se2& map_from_base,
                                    const Eigen::Matrix3d& covariance) const {
  Estimate estimate = describe_observation(observation, map_from_base, setup_.range_sigma_m);
  estimate.covariance = 0.5 * (covariance + covariance.transpose());
  estimate.covariance += in_axes(map_from_base.rotation(),
                                 unmeasured_covariance(unmeasured_motion_.possibly_stuck_m()));
  if (loaded_map_)
    estimate.covariance += covariance_at(loaded_map_->snapshot(), map_from_base.translation());
  if (relocalisation_.alternative()) {
    const Eigen::Vector3d away = pose_difference(*relocalisation_.alternative(), map_from_base);
    estimate.covariance += away * away.transpose();
  }
  if (carried_) estimate.covariance.diagonal() += unknown_pose_variances(carried_->driven_m);
  estimate.odometry_refused = odometry_check_.is_refused();
  estimate.reason = reason_;
  estimate.calibration_widened = !graph_.doubted_calibration_terms().empty();
  estimate.weak_axis_source = unmeasured_motion_.unmeasured_m() > 0.0 ? WeakAxisSource::kNothing
                              : markers_known_                        ? WeakAxisSource::kMarkers
                                                                      : WeakAxisSource::kOdometry;
  estimate.ranges_wrong = registration_.is_rescaled();
  estimate.start_refuted = loaded_map_ && loaded_map_->is_pose_refuted();
  const bool is_other_building = loaded_map_ && loaded_map_->is_of_another_building();
  const bool is_lost = carried_ || is_pose_suspicious() ||
                       inlier_share_ < config_.lost_inlier_share || estimate.start_refuted ||
                       is_other_building || survey_.is_undecided();
  const bool observes_all_axes = (is_observed_ && !estimate.observability.is_degenerate) ||
                                 estimate.weak_axis_source == WeakAxisSource::kMarkers;
  estimate.health = health_of(graph_.state().keyframes.size(), is_lost, observes_all_axes);
  return estimate;
}

}  // namespace waymark

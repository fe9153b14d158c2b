// SPDX-License-Identifier: BSD-3-Clause
#include "placement/keyframe_schedule.hpp"

#include "slam/core/estimators/waymark.hpp"
#include "slam/core/odometry/odometry_noise_learner.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark::placement {
namespace {

// If a marker is seen in this share of the scans, markers observe the motion along the path.
constexpr double kSeen = 0.5;

/// Distance between keyframes that are due every `least_m`, rounded up to whole scan intervals.
double spacing(double least_m, double apart_m) {
  constexpr double kRounding = 1e-9;
  if (!(apart_m > 0.0)) return least_m;
  return apart_m * std::max(1.0, std::ceil(least_m / apart_m - kRounding));
}

double keyframes_of(const Step& step, double spacing_m, double turn_rad) {
  const double due = std::max(step.motion.distance_m / spacing_m, step.motion.turn_rad / turn_rad);
  return step.scans > 0.0 ? std::min(due, step.scans) : due;
}

/// Sets the number of keyframes of each step, and how many of them see each marker, from the share
/// of frames in which the marker is read.
void count_keyframes(std::span<const Step> steps, const SlamConfig& config,
                     std::vector<StepPlan>& plan) {
  const WaymarkConfig& waymark = config.slam.waymark;
  const double frames_per_scan =
      std::max(1.0, config.robot.camera.rate_hz / config.robot.lidar.rate_hz);
  double sum = 0.0;
  for (std::size_t i = 0; i < steps.size(); ++i) {
    const Step& step = steps[i];
    double blank_frame = 1.0;
    for (const StepSighting& sighting : plan[i].sightings)
      blank_frame *= 1.0 - sighting.view->read_share;
    const double seen = 1.0 - std::pow(blank_frame, frames_per_scan);  // share of scans
    // The first scan is a keyframe.
    const double apart_m = step.scans > 0.0 ? step.motion.distance_m / step.scans : 0.0;
    const auto made = [&](double least_m) {
      return i == 0 ? 1.0
                    : keyframes_of(step, spacing(least_m, apart_m), waymark.keyframe_turn_rad);
    };
    const double with_markers = seen * made(waymark.marker_keyframe_distance_m);
    const double without = (1.0 - seen) * made(waymark.keyframe_distance_m);
    for (StepSighting& sighting : plan[i].sightings)
      sighting.keyframes = with_markers * sighting.view->read_share / (1.0 - blank_frame);
    plan[i].keyframes_before = sum;
    plan[i].keyframes = with_markers + without;
    plan[i].shows_way = !step.observed.is_degenerate || seen >= kSeen;
    sum += plan[i].keyframes;
  }
}

/// The step in which the keyframe with that (fractional) index is made.
std::size_t step_of(double keyframe, const std::vector<StepPlan>& plan) {
  const auto after = std::upper_bound(
      plan.begin(), plan.end(), keyframe,
      [](double value, const StepPlan& step) { return value < step.keyframes_before; });
  return after == plan.begin() ? 0 : static_cast<std::size_t>(after - plan.begin()) - 1;
}

/// Scans are inserted into two submaps at a time and matched with the older one; see
/// WaymarkEstimator::insert_scan() and add_scan_factor().
void choose_submaps(const WaymarkConfig& config, std::vector<StepPlan>& plan) {
  constexpr double kGroup{kGroupedKeyframes};
  const double half = std::max(1, config.submap_keyframes / 2);
  for (std::size_t i = 1; i < plan.size(); ++i) {
    const double now = plan[i].keyframes_before;
    const double first = std::max(0.0, half * (std::floor((now - 1.0) / half) - 1.0));
    double sum = 0.0;
    for (double group = std::floor(first / kGroup) * kGroup; group < now; group += kGroup) {
      const double begin = std::max(group, first);
      const double end = std::min(group + kGroup, now);
      if (end <= begin) continue;
      const double middle =
          std::clamp(group + std::floor(0.5 * kGroup), begin, std::max(begin, end - 1.0));
      const std::size_t step = std::min(step_of(middle, plan), i - 1);
      plan[i].submap.emplace_back(step, end - begin);
      sum += end - begin;
    }
    for (auto& [step, share] : plan[i].submap)
      share /= sum;
  }
}

/// Chooses the loop closures: once per loops.every_m, a step whose walls observe all directions
/// closes a loop with the nearest old step within loops.reach_m whose walls do so, too.
void choose_loops(std::span<const Step> steps, const WaymarkConfig& config,
                  std::vector<StepPlan>& plan) {
  if (!config.loops.enabled) return;
  double searched_m = 0.0;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i].observed.is_degenerate || steps[i].travel_m - searched_m < config.loops.every_m) {
      continue;
    }
    searched_m = steps[i].travel_m;
    double least_m = config.loops.reach_m;
    for (std::size_t k = 0; k < i; ++k) {
      // Step k and later ones are too recent: their scans are in the submaps being filled.
      if (plan[i].keyframes_before - plan[k].keyframes_before < 2.0 * config.submap_keyframes)
        break;
      const double away_m =
          (steps[i].map_from_base.translation() - steps[k].map_from_base.translation()).norm();
      if (away_m >= least_m || steps[k].observed.is_degenerate) continue;
      least_m = away_m;
      plan[i].loop = k;
    }
  }
}

/// An innovation of average size (one standard deviation).
OdometryInnovation usual(double odometry_variance, double other_variance, double distance_m) {
  return {std::sqrt(odometry_variance + other_variance), odometry_variance, other_variance,
          distance_m};
}

/// Share of the slips that walls and markers do not show, as WaymarkEstimator::hidden_slips().
double hidden_slips(const Step& step, const StepPlan& plan) {
  if (!step.observed.is_degenerate) return 0.0;
  if (!plan.shows_way) return 1.0;
  std::vector<Eigen::Matrix2d> places;
  for (const StepSighting& sighting : plan.sightings)
    places.emplace_back(sighting.view->measurement.covariance.topLeftCorner<2, 2>());
  return hidden_share(step.motion, places, plan.noise);
}

/// Sets the noise scale and the hidden slips at each step by running the estimator's learner on
/// average innovations.
void follow_noise(std::span<const Step> steps, const WaymarkConfig& config,
                  std::vector<StepPlan>& plan) {
  OdometryNoiseLearner learner;
  double unobserved_m = 0.0;
  const double along_m2_per_m = config.odometry.along_per_sqrt_m * config.odometry.along_per_sqrt_m;
  for (std::size_t i = 1; i < steps.size(); ++i) {
    const Step& step = steps[i];
    const auto count = std::max(1L, std::lround(plan[i].keyframes));
    const double distance_m = step.motion.distance_m / static_cast<double>(count);
    const double turn_rad = step.motion.turn_rad / static_cast<double>(count);
    const Eigen::Matrix3d& information = step.observed.information;
    for (long k = 0; config.learn_noise && k < count; ++k) {
      if (information(2, 2) > 0.0) {
        learner.observe_turn(usual(turn_variance(config.odometry, distance_m, turn_rad),
                                   2.0 / information(2, 2), distance_m));
      }
      if (!step.observed.is_degenerate) {
        const double by_scan = 2.0 * Eigen::Matrix3d{information.inverse()}(0, 0);
        learner.observe_along(usual(along_m2_per_m * distance_m, by_scan, distance_m));
        unobserved_m = 0.0;
      } else {
        unobserved_m += distance_m;
      }
      const bool sees_marker =
          !plan[i].sightings.empty() && (step.observed.is_degenerate ? plan[i].shows_way : true);
      if (!sees_marker) continue;
      if (unobserved_m > 0.0) {
        const MarkerMeasurement& measured = plan[i].sightings.front().view->measurement;
        const OdometryInnovation along =
            usual(along_m2_per_m * unobserved_m, measured.covariance(0, 0), unobserved_m);
        learner.observe_slip(along);
        learner.observe_along(along);
      }
      unobserved_m = 0.0;
    }
    plan[i].noise = learner.learnt_noise();
  }
  if (plan.size() > 1) plan[0].noise = plan[1].noise;
  for (std::size_t i = 0; i < steps.size(); ++i)
    plan[i].hidden_slips = hidden_slips(steps[i], plan[i]);
}

}  // namespace

std::vector<StepPlan> plan_keyframes(std::span<const Step> steps,
                                     std::span<const Sightings* const> markers,
                                     const SlamConfig& config) {
  std::vector<StepPlan> plan(steps.size());
  for (std::size_t marker = 0; marker < markers.size(); ++marker)
    for (const Sighting& sighting : *markers[marker])
      plan[sighting.step].sightings.push_back({marker, &sighting.view, 0.0});
  count_keyframes(steps, config, plan);
  choose_submaps(config.slam.waymark, plan);
  choose_loops(steps, config.slam.waymark, plan);
  follow_noise(steps, config.slam.waymark, plan);
  for (std::size_t i = 0; i < plan.size(); ++i)
    plan[i].leaves_window =
        std::max(i, step_of(plan[i].keyframes_before + config.slam.waymark.window_keyframes, plan));
  return plan;
}

}  // namespace waymark::placement

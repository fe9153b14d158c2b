// SPDX-License-Identifier: BSD-3-Clause
// Predicts the keyframes that the estimator would make on a drive, the submaps and loops that it
// would match their scans with, and the odometry noise that it would learn.
#pragma once

#include "placement/covariance_model.hpp"
#include "slam/core/motion/odometry_mixture.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace waymark::placement {

/// A marker seen during a step.
struct StepSighting {
  std::size_t marker{0};
  const MarkerView* view{nullptr};
  double keyframes{0.0};  ///< expected number of keyframes that measure it
};

struct StepPlan {
  double keyframes{0.0};         ///< expected number of keyframes in the step
  double keyframes_before{0.0};  ///< in all steps before
  bool shows_way{false};         ///< walls or markers observe the motion along the path
  double hidden_slips{0.0};      ///< share of odometry's slips that walls and markers do not show
  std::vector<StepSighting> sightings{};
  /// Steps whose poses represent the submap that the scans are matched with, and their shares.
  std::vector<std::pair<std::size_t, double>> submap{};
  std::optional<std::size_t> loop{};  ///< an old step with which a loop is closed
  LearntOdometryNoise noise{};        ///< learnt up to this step
  std::size_t leaves_window{0};       ///< the step at which this step's factors are marginalised
};

std::vector<StepPlan> plan_keyframes(std::span<const Step> steps,
                                     std::span<const Sightings* const> markers,
                                     const SlamConfig& config);

}  // namespace waymark::placement

// SPDX-License-Identifier: BSD-3-Clause
// Which keyframes the estimator would make on a drive, what it would match their scans with, and
// how noisy it would take the odometry for.
#pragma once

#include "placement/covariance_model.hpp"
#include "slam/core/graph/factors.hpp"

#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace waymark::placement {

/// A marker in a step.
struct StepSighting {
  std::size_t marker{0};
  const MarkerView* view{nullptr};
  double keyframes{0.0};  ///< that measure it
};

struct StepPlan {
  double keyframes{0.0};  ///< made in it
  double keyframes_before{0.0};
  bool shows_way{false};  ///< walls or markers show the motion along
  std::vector<StepSighting> sightings{};
  /// Steps whose poses stand for the submap that its scans are matched with, and their shares.
  std::vector<std::pair<std::size_t, double>> submap{};
  std::optional<std::size_t> loop{};  ///< an old step whose walls it finds again
  OdometryScale noise{};              ///< as known at that step
  std::size_t leaves_window{0};       ///< the step at which its factors are fixed
};

std::vector<StepPlan> plan_keyframes(std::span<const Step> steps,
                                     std::span<const Sightings* const> markers,
                                     const SlamConfig& config);

}  // namespace waymark::placement

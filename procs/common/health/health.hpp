// SPDX-License-Identifier: BSD-3-Clause
// How an estimator judges its pose; numbers as in lcmtypes/slam_estimate_t.lcm.
#pragma once

#include <cstdint>
#include <string_view>

namespace waymark {

enum class Health : std::int8_t { kUnknown, kInitialising, kTracking, kDegenerate, kLost };

/// What observes the motion in the direction that the walls observe least.
enum class WeakAxisSource : std::int8_t { kUnknown, kOdometry, kMarkers, kNothing };

/// kUnknown for a number that is none of a Health.
constexpr Health to_health(std::int64_t number) {
  const bool is_known = number >= 0 && number <= static_cast<std::int64_t>(Health::kLost);
  return is_known ? static_cast<Health>(number) : Health::kUnknown;
}

constexpr WeakAxisSource to_weak_axis_source(std::int64_t number) {
  const bool is_known =
      number >= 0 && number <= static_cast<std::int64_t>(WeakAxisSource::kNothing);
  return is_known ? static_cast<WeakAxisSource>(number) : WeakAxisSource::kUnknown;
}

/// "tracking", "degenerate", ...: the names of HEALTH_*.
constexpr std::string_view name_of(Health health) {
  switch (health) {
    case Health::kInitialising:
      return "initialising";
    case Health::kTracking:
      return "tracking";
    case Health::kDegenerate:
      return "degenerate";
    case Health::kLost:
      return "lost";
    case Health::kUnknown:
      break;
  }
  return "unknown";
}

}  // namespace waymark

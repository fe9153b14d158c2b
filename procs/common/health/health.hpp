// SPDX-License-Identifier: BSD-3-Clause
// How an estimator judges its pose; numbers as in lcmtypes/slam_estimate_t.lcm.
#pragma once

#include <cstdint>
#include <string_view>

namespace waymark {

enum class Health : std::int8_t { kUnknown, kInitialising, kTracking, kDegenerate, kLost };

/// Which measurements determine the motion along the weak axis, the direction that the walls
/// determine least.
enum class WeakAxisSource : std::int8_t { kUnknown, kOdometry, kMarkers, kNothing };

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

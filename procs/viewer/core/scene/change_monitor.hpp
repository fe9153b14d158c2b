// SPDX-License-Identifier: BSD-3-Clause
// What people want to be told once, when it happens: lost, found again, a marker that has moved.
#pragma once

#include "viewer/core/scene/scene.hpp"

#include <map>
#include <optional>
#include <string>
#include <utility>
#include <vector>

namespace waymark::viewer {

struct Change {
  enum class Kind { kNote, kAlarm };

  Kind kind{Kind::kNote};
  std::string text{};  ///< one line

  bool operator==(const Change&) const = default;
};

/// Sees everything, and speaks only when something differs from what it saw before.
class ChangeMonitor {
 public:
  /// Initialising, localised or lost. An axis that comes and goes is no news in a corridor: the
  /// map shows where.
  std::optional<Change> see(const EstimatedPose& estimate);

  /// Markers that are new, gone, or in another state than before; by id and instance.
  std::vector<Change> see(Timestamp time, const std::vector<Landmark>& landmarks);

 private:
  enum class Phase { kUnknown, kInitialising, kLocalised, kLost };

  struct Sighting {
    LandmarkState state{LandmarkState::kUnknown};
    Eigen::Vector2d position_m{Eigen::Vector2d::Zero()};
  };

  static Phase phase_of(Health health);

  Phase phase_{Phase::kUnknown};
  Timestamp lost_since_{};
  std::map<std::pair<int, int>, Sighting> known_;  ///< by id and instance
};

}  // namespace waymark::viewer

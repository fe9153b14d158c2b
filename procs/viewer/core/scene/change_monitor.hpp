// SPDX-License-Identifier: BSD-3-Clause
// Changes that are reported once, when they happen: lost, found again, a marker that has moved.
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

/// Takes every estimate and marker map, and reports what differs from the one before.
class ChangeMonitor {
 public:
  /// Initialising, localised or lost. An axis that comes and goes in a corridor is not reported:
  /// the map shows where.
  std::optional<Change> update(const EstimatedPose& estimate);

  /// Markers that are new, gone, or in another state than before; by id and instance.
  std::vector<Change> update(Timestamp time, const std::vector<Landmark>& landmarks);

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

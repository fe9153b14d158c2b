// SPDX-License-Identifier: BSD-3-Clause
// Reports each change of state once: lost, localised again, a marker that has moved.
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

/// Compares each estimate and each marker map with the one before.
class ChangeMonitor {
 public:
  /// Reports changes between initialising, localised and lost. `tracking` and `degenerate` both
  /// count as localised: in a corridor they alternate.
  std::optional<Change> update(const EstimatedPose& estimate);

  /// Reports markers that are new, gone, or in another state than before; by id and instance.
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

// SPDX-License-Identifier: BSD-3-Clause
// Which map slam's messages belong to.
#pragma once

#include "common/time/clock_step_detector.hpp"

#include <cstdint>
#include <optional>

namespace waymark::viewer {

/// Distinguishes messages of a new map (slam was restarted or reset) from late messages of an
/// earlier map, which are stamped before the current map's first message. Many such messages in a
/// row mean that the clock was set back: then they are of a new map.
class CurrentMap {
 public:
  enum class Origin { kOfThisMap, kOfFirstMap, kOfNewMap, kLate };

  /// @return which map the message is of. With kOfFirstMap or kOfNewMap, it is the current map now.
  Origin update(std::int64_t map_id, Timestamp time) {
    if (map_id == id_) {
      clock_.note_consistent();
      return Origin::kOfThisMap;
    }
    if (id_ && time < began_ && !clock_.note_inconsistent(time)) return Origin::kLate;
    const Origin origin = id_ ? Origin::kOfNewMap : Origin::kOfFirstMap;
    id_ = map_id;
    began_ = time;
    return origin;
  }

  std::optional<std::int64_t> id() const { return id_; }

 private:
  std::optional<std::int64_t> id_{};
  Timestamp began_{};
  ClockStepDetector clock_{};  ///< counts older messages of other maps
};

}  // namespace waymark::viewer

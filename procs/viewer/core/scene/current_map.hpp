// SPDX-License-Identifier: BSD-3-Clause
// Which map slam's messages belong to.
#pragma once

#include "common/time/clock_step_detector.hpp"

#include <cstdint>
#include <optional>

namespace waymark::viewer {

/// Distinguishes a new map, after a restart or a reset of slam, from late messages of an earlier
/// one. So many of these that the clock was set back are a new map.
class CurrentMap {
 public:
  enum class Origin { kOfThisMap, kOfFirstMap, kOfNewMap, kLate };

  /// After kOfFirstMap and kOfNewMap this is the map of the message.
  Origin take(std::int64_t map_id, Timestamp time) {
    if (map_id == id_) {
      clock_.see_fitting();
      return Origin::kOfThisMap;
    }
    if (id_ && time < began_ && !clock_.see_misfit(time)) return Origin::kLate;
    const Origin origin = id_ ? Origin::kOfNewMap : Origin::kOfFirstMap;
    id_ = map_id;
    began_ = time;
    return origin;
  }

  std::optional<std::int64_t> id() const { return id_; }

 private:
  std::optional<std::int64_t> id_{};
  Timestamp began_{};
  ClockStepDetector clock_{};  ///< of the messages of another map
};

}  // namespace waymark::viewer

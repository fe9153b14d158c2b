// SPDX-License-Identifier: BSD-3-Clause
// Notices that the robot is not where it is believed to be, and where it is instead.
#pragma once

#include "slam/core/belief/belief.hpp"

#include <optional>
#include <set>
#include <span>

namespace waymark {

/// Weighs two stories about sighted markers: the robot is where it is believed to be, and a marker
/// that seems to be elsewhere was moved, is misread or has a double; or the robot is elsewhere (it
/// was lifted, or slipped), as the known places of those markers tell.
///
/// A marker that is where it is expected, or that is new, speaks for the belief. A marker that is
/// known, the only one of its id, and not where it is seen speaks for the other place. One such
/// marker alone is a doubt; two that agree about the other place while none speaks for the belief
/// settle it.
class KidnapWatch {
 public:
  enum class Verdict {
    kSettled,    ///< the robot is where it is believed to be
    kDoubtful,   ///< until the next marker: nothing is to be mapped
    kElsewhere,  ///< the robot has to be put to where relocating_marker() was seen from
  };

  /// @param belief  of the moment before the markers were sighted, moved to now.
  /// @param motion  since the last call.
  /// @param gate, near_m  when a marker is where it is expected, see Innovation::may_be_it.
  Verdict judge(const Belief& belief, std::span<const MarkerMeasurement> seen, const Motion& motion,
                double gate, double near_m);

  /// The other place, while there is a doubt.
  const std::optional<Se2>& elsewhere() const { return elsewhere_; }

  /// What to relocate by after kElsewhere.
  const MarkerMeasurement& relocating_marker() const { return relocating_marker_; }

 private:
  void forget();
  void count_for_elsewhere(int id, const Se2& map_from_base);

  std::optional<Se2> elsewhere_{};
  std::set<int> ids_for_elsewhere_{};
  double doubted_m_{0.0};  ///< way since the doubt began
  MarkerMeasurement relocating_marker_{};
};

}  // namespace waymark

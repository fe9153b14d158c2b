// SPDX-License-Identifier: BSD-3-Clause
// Notices that the robot is not where it is believed to be, and where it is instead.
#pragma once

#include "slam/core/belief/belief.hpp"

#include <map>
#include <optional>
#include <set>
#include <span>

namespace waymark {

/// Weighs two stories about sighted markers: the robot is where it is believed to be, and a marker
/// that seems to be elsewhere was moved, is misread or has a double; or the robot is elsewhere (it
/// was lifted, or slipped), as the known places of those markers tell.
///
/// A marker that is where it is expected, or that is new, speaks for the belief. A marker that is
/// known, confirmed, the only one of its id, and not where it is seen speaks for the other place.
/// One such marker alone is a doubt; two that agree about the other place while none speaks for the
/// belief settle it.
class KidnapWatch {
 public:
  enum class Verdict {
    kSettled,    ///< the robot is where it is believed to be
    kDoubtful,   ///< until the next marker: nothing is to be mapped
    kElsewhere,  ///< the robot has to be put to where relocating_marker() was seen from
    kBack,       ///< doubles: the robot has to be put to returning_pose()
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

  /// Where the robot would be had it not been relocated; of use after kBack.
  const Se2& returning_pose() const { return *unbelieved_; }

 private:
  void follow(const Motion& motion);
  void forget_doubt();
  void count_for_elsewhere(int id, const Se2& map_from_base);
  int sightings() const;  ///< that have fed the doubt
  bool is_elsewhere() const;
  bool doubles_explain(const Belief& belief, std::span<const MarkerMeasurement> seen);

  std::optional<Se2> elsewhere_{};
  std::map<int, int> ids_for_elsewhere_{};  ///< with the number of sightings
  double unsupported_m_{0.0};               ///< way since the last of them
  MarkerMeasurement relocating_marker_{};

  // After a relocation:
  std::optional<Se2> unbelieved_{};  ///< the pose that was given up, as odometry carries it on
  std::set<int> strangers_{};        ///< new ids where others should be
  double relocated_m_{0.0};          ///< way since
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Pairs estimates with the poses of another channel at their times.
#pragma once

#include "common/time/clock_step_detector.hpp"
#include "viewer/core/scene/scene.hpp"

#include <cstdint>
#include <deque>
#include <optional>
#include <vector>

namespace waymark::exporting {

/// Poses of the base at one time, in the map and in the channel's frame.
struct PosePair {
  Timestamp time{};
  Se2 map_from_base{};
  Se2 frame_from_base{};
};

/// An estimate waits for the channel's poses around it, which are interpolated.
///
/// Stamps may be wrong: the newest pose is held back until the next one has a later stamp, so that
/// a lone pose whose stamp is ahead or behind loses only itself. When the clock was set back, the
/// poses before are forgotten.
class PosePairing {
 public:
  void add_pose(const viewer::TimedPose& frame_from_base);
  void add_estimate(const viewer::TimedPose& map_from_base);

  void forget_estimates() { waiting_.clear(); }

  /// To be called when no more poses come.
  void finish();

  /// The poses whose stamps have turned out to be right since the last call.
  std::vector<viewer::TimedPose> take_poses();
  /// The pairs since the last call.
  std::vector<PosePair> take_pairs();

  std::int64_t num_dropped_poses() const { return num_dropped_poses_; }

  /// Estimates without poses around them: before the first, after the last, or in a gap of more
  /// than a second.
  std::int64_t num_unpaired() const { return num_unpaired_; }

 private:
  bool is_newer(Timestamp time) const { return poses_.empty() || time > poses_.back().time; }

  void accept(const viewer::TimedPose& pose);
  void begin_anew(const viewer::TimedPose& pose);
  std::optional<Se2> pose_at(Timestamp time) const;

  std::deque<viewer::TimedPose> poses_{};
  std::optional<viewer::TimedPose> held_back_{};
  std::vector<viewer::TimedPose> waiting_{};  ///< estimates that wait for the next pose
  std::vector<viewer::TimedPose> new_poses_{};
  std::vector<PosePair> new_pairs_{};
  ClockStepDetector clock_steps_{};
  std::int64_t num_dropped_poses_{0};
  std::int64_t num_unpaired_{0};
};

}  // namespace waymark::exporting

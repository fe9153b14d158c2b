// SPDX-License-Identifier: BSD-3-Clause
// The pose at every scan of a run, relative to keyframes.
#pragma once

#include "slam/core/estimators/scan_trajectory.hpp"
#include "slam/core/motion/pose_sequence.hpp"

#include <cstddef>
#include <vector>

namespace waymark {

/// Pose of a scan relative to the newest keyframe at that time.
struct ScanPose {
  Timestamp time{};
  std::size_t keyframe{0};
  Se2 keyframe_from_base{};
  double clock_s{0.0};      ///< `time`, without steps of the clock
  bool is_observed{false};  ///< markers or walls observe the pose in every direction
};

/// About 60 bytes for each scan.
class ScanPoses {
 public:
  void add(const ScanPose& scan) { scans_.push_back(scan); }

  /// Corrects the scans since `start` for odometry that was stuck: their poses are interpolated
  /// linearly in time between those that are known, which are `start`, the scans that markers or
  /// walls observed, and `end`.
  void spread_motion(const ScanPose& start, const ScanPose& end, const PoseSequence& keyframes);

  std::vector<TimedPose> along(const PoseSequence& keyframes) const;

 private:
  std::vector<ScanPose> scans_{};
};

}  // namespace waymark

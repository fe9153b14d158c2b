// SPDX-License-Identifier: BSD-3-Clause
// Why a sensor value was not used, or was used only in part.
#pragma once

#include <cstddef>
#include <utility>
#include <vector>

namespace waymark {

enum class Skip {
  kOdometryOutOfOrder,
  kOdometryAhead,   ///< stamped later than any pause explains, or than the samples after it
  kClockSet,        ///< waiting scans and frames are dropped; the motion continues
  kOdometryJumped,  ///< the jump is not used as motion
  kOdometryStuck,   ///< stood still or jumped, then reported the motion in one step
  kScanOutOfOrder,
  kScanAhead,           ///< stamped far ahead of odometry, or ahead of the scans that followed
  kScanWithoutReturns,  ///< odometry and camera frames up to its time are used
  kScanRepeated,        ///< identical to a scan from another place: the LiDAR is stuck
  kScanBeforeOdometry,
  kScanWithoutOdometry,  ///< the input ended before odometry covered the scan
  kScanOverflow,         ///< waited too long for odometry
  kFrameOutOfOrder,
  kFrameAhead,            ///< stamped far ahead of odometry, or ahead of the frames that followed
  kFrameWithoutOdometry,  ///< odometry of that time was dropped already, or begins later
  kFrameOverflow,
  kFrameRepeated,  ///< detections identical to the previous frame's: the camera is stuck
  kMarkerImplausible,
  kMarkerUncertain,
};

/// Reasons in order of time.
class Skips {
 public:
  void add(Skip reason, std::size_t times = 1) { all_.insert(all_.end(), times, reason); }

  /// The reasons added since the last call.
  std::vector<Skip> take() { return std::exchange(all_, {}); }

 private:
  std::vector<Skip> all_{};
};

}  // namespace waymark

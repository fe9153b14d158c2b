// SPDX-License-Identifier: BSD-3-Clause
// Why a sensor value was not used.
#pragma once

#include <cstddef>
#include <string_view>
#include <utility>
#include <vector>

namespace waymark {

enum class Skip {
  kOdometryOutOfOrder,
  kOdometryAhead,   ///< later than any pause explains, or than the samples after it
  kClockSet,        ///< what waits is dropped, motion goes on
  kOdometryJumped,  ///< used as a new beginning, its jump is not
  kOdometryStuck,   ///< stood still or jumped about, then reported the way in one step
  kScanOutOfOrder,
  kScanAhead,           ///< of odometry by far, or of the scans that followed it
  kScanWithoutReturns,  ///< odometry and camera are
  kScanRepeated,        ///< range for range one from elsewhere: the LiDAR is stuck
  kScanBeforeOdometry,
  kScanWithoutOdometry,  ///< the input ended before the odometry for it came
  kScanOverflow,         ///< odometry stays away
  kFrameOutOfOrder,
  kFrameAhead,            ///< of odometry by far, or of the frames that followed it
  kFrameWithoutOdometry,  ///< it has been forgotten, or begins later
  kFrameOverflow,
  kFrameRepeated,  ///< pixel for pixel the one before: the camera is stuck, or nothing moves
  kMarkerImplausible,
  kMarkerUncertain,
};

std::string_view to_string(Skip skip);

/// In order of time.
class Skips {
 public:
  void add(Skip reason, std::size_t times = 1) { all_.insert(all_.end(), times, reason); }

  /// What was added since the last call.
  std::vector<Skip> take() { return std::exchange(all_, {}); }

 private:
  std::vector<Skip> all_{};
};

}  // namespace waymark

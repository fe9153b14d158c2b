// SPDX-License-Identifier: BSD-3-Clause
// The estimate for programs that track the robot by odometry.
#pragma once

#include "common/messages/channels.hpp"
#include "slam/core/estimators/estimate.hpp"

#include <optional>

namespace waymark {

/// Makes SLAM_CORRECTION from estimates with a pose; keeps the previous one to compute jumps.
class CorrectionMaker {
 public:
  /// @param odom_from_base  odometry as it was sent, at the time of the estimate.
  /// @return map_from_odometry: composed with that odometry, it gives the estimated pose.
  correction_t make(const Estimate& estimate, const Se2& odom_from_base, std::int64_t map_id);

  /// To be called for a new map: the next correction is no jump.
  void forget() { before_.reset(); }

 private:
  std::optional<Se2> before_{};  ///< map_from_odometry
};

}  // namespace waymark

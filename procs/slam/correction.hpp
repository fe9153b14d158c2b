// SPDX-License-Identifier: BSD-3-Clause
// The estimate for followers that have an odometry of their own.
#pragma once

#include "common/messages/channels.hpp"
#include "slam/core/filter/estimate.hpp"

#include <optional>

namespace waymark {

/// Makes SLAM_CORRECTION of estimates with a pose, and keeps the one before.
class CorrectionMaker {
 public:
  /// @param odom_from_base  odometry as it was sent, at the time of the estimate.
  /// @return map_from_odometry: composed with that odometry it is the estimated pose.
  correction_t make(const Estimate& estimate, const Se2& odom_from_base, std::int64_t map_id);

  /// Another map: what comes next is no jump.
  void forget() { before_.reset(); }

 private:
  std::optional<Se2> before_{};  ///< map_from_odometry
};

}  // namespace waymark

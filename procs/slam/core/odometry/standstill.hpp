// SPDX-License-Identifier: BSD-3-Clause
// A time without motion by odometry: the robot stands, or odometry is stuck.
#pragma once

#include "slam/core/motion/motion.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>

namespace waymark {

class Standstill {
 public:
  /// @param keyframe       odometry is measured from it.
  /// @param motion         since `keyframe`.
  /// @param map_from_base  estimated pose.
  /// @param clock_s        time, without steps of the clock.
  Standstill(std::size_t keyframe, const Motion& motion, const Se2& map_from_base, double clock_s)
      : keyframe_{keyframe},
        motion_{motion},
        map_from_start_{map_from_base},
        map_from_moved_{map_from_base},
        since_s_{clock_s},
        moved_at_s_{clock_s} {}

  std::size_t keyframe() const { return keyframe_; }

  /// From `keyframe` to the standstill.
  const Motion& motion() const { return motion_; }

  const Se2& map_from_start() const { return map_from_start_; }

  double since_s() const { return since_s_; }

  /// `keyframe` is where the robot stands.
  void note_keyframe_here() { motion_ = {}; }

  /// Motion that was observed although odometry stands still.
  struct Observed {
    double distance_m{0.0};
    double elapsed_s{0.0};
    bool has_returned{false};  ///< the robot stands after all: a scan had been mismatched
  };

  /// Compares the estimated pose of a new keyframe with the last one at which the robot was
  /// observed to move.
  std::optional<Observed> compare(const Se2& map_from_base, double clock_s);

 private:
  std::size_t keyframe_;
  Motion motion_;
  Se2 map_from_start_;
  Se2 map_from_moved_;  ///< pose when the robot was last observed to move
  double since_s_;
  double moved_at_s_;
  Eigen::Vector3d farthest_{Eigen::Vector3d::Zero()};  ///< largest |x|, |y|, |theta| from the start
};

}  // namespace waymark

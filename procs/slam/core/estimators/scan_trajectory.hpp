// SPDX-License-Identifier: BSD-3-Clause
// The pose at every scan of a run, from the poses at the filter's updates and odometry in between.
#pragma once

#include "common/time/time.hpp"
#include "slam/core/motion/motion.hpp"

#include <span>
#include <vector>

namespace waymark {

/// Pose of the base at a time.
struct TimedPose {
  Timestamp time{};
  Se2 map_from_base{};
};

/// Keeps the odometry of every scan of a run: about 100 bytes each.
class ScanTrajectory {
 public:
  /// @param motion     since the previous scan.
  /// @param is_update  whether along() gets a pose of this scan; must be true for the first scan.
  void add(Timestamp time, const Motion& motion, bool is_update);

  /// One pose per scan. Between two updates the poses follow odometry, and the difference that
  /// remains at the second update is distributed over them in proportion to the motion. After the
  /// last update the poses follow odometry.
  /// @param map_from_updates  one pose per update.
  std::vector<TimedPose> along(std::span<const Se2> map_from_updates) const;

 private:
  struct Scan {
    Timestamp time{};
    Motion since_update{};  ///< since the previous update
    bool is_update{false};
  };

  std::vector<Scan> scans_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Dead reckoning from the encoder ticks of a differential drive.
#pragma once

#include "import/log/imported_log.hpp"
#include "import/mbot/foreign_messages.hpp"

#include <span>
#include <vector>

namespace waymark {

struct WheelGeometry {
  double meters_per_tick{0.0};
  double wheel_base_m{0.0};
};

/// Robots of the course ROB 550 (University of Michigan): 1200 ticks per wheel turn of 0.100528 m;
/// those of 2014: 480 ticks per turn of a wheel of 0.032 m diameter.
WheelGeometry geometry_of(RobotModel model);

/// One pose (odom_from_base) per reading, starting at the origin; each step is a straight line at
/// half the turn. A step faster than 10 m/s (a reset or garbled counter) is reported and counts as
/// no motion.
/// @param ticks  ascending times
std::vector<ImportedPose> wheel_odometry(std::span<const EncoderTicks> ticks,
                                         const WheelGeometry& geometry, ImportReport& report);

}  // namespace waymark

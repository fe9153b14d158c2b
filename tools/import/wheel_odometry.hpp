// SPDX-License-Identifier: BSD-3-Clause
// Encoder ticks of a differential drive -> poses.
#pragma once

#include "import/foreign_messages.hpp"
#include "import/imported_log.hpp"

#include <span>
#include <vector>

namespace waymark {

/// Defaults: MAEBot (ROB 550).
struct WheelGeometry {
  double meters_per_tick{0.100528 / 1200.0};  ///< circumference of a wheel / ticks per turn
  double wheel_base_m{0.08};
};

/// Dead reckoning from the origin: one pose per reading, each step an arc approximated by its chord
/// at half the turn. A step faster than any such robot (10 m/s: a counter that was reset or
/// garbled) is named, and the robot counts as not having moved in it.
/// @param ticks  ascending times
std::vector<ImportedPose> wheel_odometry(std::span<const EncoderTicks> ticks,
                                         const WheelGeometry& geometry, ImportReport& report);

}  // namespace waymark

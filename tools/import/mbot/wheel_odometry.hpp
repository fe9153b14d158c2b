// SPDX-License-Identifier: BSD-3-Clause
// Encoder ticks of a differential drive -> poses.
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

/// Both robots are of ROB 550: 1200 ticks per turn of 0.100528 m; in 2014 480 per turn of a wheel
/// of 0.032 m diameter.
WheelGeometry geometry_of(Encoders encoders);

/// Dead reckoning from the origin: one pose per reading, each step an arc approximated by its chord
/// at half the turn. A step faster than any such robot (10 m/s: a counter that was reset or
/// garbled) is named, and the robot counts as not having moved in it.
/// @param ticks  ascending times
std::vector<ImportedPose> wheel_odometry(std::span<const EncoderTicks> ticks,
                                         const WheelGeometry& geometry, ImportReport& report);

}  // namespace waymark

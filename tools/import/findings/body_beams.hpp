// SPDX-License-Identifier: BSD-3-Clause
// Beams that end on the robot itself.
#pragma once

#include "import/log/imported_log.hpp"

#include <vector>

namespace waymark {

struct BodyBeams {
  std::vector<bool> is_body{};  ///< by index of the beam; empty: none
  int count{0};
  double longest_m{0.0};
};

/// Beams below 1 m whose range stays as it is while the robot drives and turns: a wall comes
/// nearer and goes away. Nothing of a robot that has driven less than 20 m or turned less than a
/// full turn.
BodyBeams find_body_beams(const ImportedLog& log);

/// The scan as it is seen past the robot.
LidarScan without_body(LidarScan scan, const BodyBeams& body);

/// The same in_order_of_angles, as misfit_m() takes it.
LidarScan usable(const ImportedScan& scan, const BodyBeams& body);

}  // namespace waymark

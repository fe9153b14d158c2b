// SPDX-License-Identifier: BSD-3-Clause
// Beams that end on the robot itself.
#pragma once

#include "import/log/imported_log.hpp"

#include <vector>

namespace waymark {

struct BodyBeams {
  std::vector<bool> is_body{};  ///< by index of the beam; empty if there are none
  int count{0};
  double longest_m{0.0};
};

/// Finds beams shorter than 1 m whose range stays the same while the robot drives and turns. Finds
/// none for a robot that has driven less than 20 m or turned less than one revolution.
BodyBeams find_body_beams(const ImportedLog& log);

/// The scan with the ranges of these beams set to NaN.
LidarScan without_body(LidarScan scan, const BodyBeams& body);

/// in_order_of_angles(without_body()), the input of misfit_m().
LidarScan usable(const ImportedScan& scan, const BodyBeams& body);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Scans with evenly spaced beams, as Foxglove's LaserScan has them.
#pragma once

#include <span>
#include <vector>

namespace waymark::exporting {

/// Beam i of n has the angle start + i * (end - start) / (n - 1).
struct EvenScan {
  double start_angle_rad{0.0};
  double end_angle_rad{0.0};  ///< not before the start; may exceed pi
  std::vector<float> ranges_m{};
};

/// Beams that are evenly spaced in either direction stay as they are, in ascending order. Others
/// are put on a grid of four places per beam, so that a beam turns by an eighth of the mean spacing
/// at most; where two fall onto one place, the nearer one stays.
/// @param angles_rad  at least one; finite; each less than half a turn from the one before.
/// @param ranges_m    as many; neither infinity nor NaN is a range: the place then has 0, as have
///                    places without a beam.
EvenScan even_scan(std::span<const float> angles_rad, std::span<const float> ranges_m);

}  // namespace waymark::exporting

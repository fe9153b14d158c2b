// SPDX-License-Identifier: BSD-3-Clause
// Misfit of two scans for a given motion.
#pragma once

#include "common/sensors/sensors.hpp"

#include <optional>

namespace waymark {

inline constexpr double kShortestRange_m = 0.05;  ///< shorter ranges are not measurements

/// The scan with angles in (-pi, pi], ascending; beams without a return are left out.
LidarScan in_order_of_angles(const LidarScan& scan);

/// Mean absolute difference [m], each at most 0.3 m, between the ranges of the first scan and those
/// that the second one predicts there; nullopt when fewer than 30 beams fall onto walls of the
/// first scan. O(n log n); the motion is not optimised.
/// @param first, second  in_order_of_angles().
std::optional<double> misfit_m(const LidarScan& first, const LidarScan& second,
                               const Se2& first_from_second);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Straightness of walls in a scan.
#pragma once

#include <optional>
#include <span>

namespace waymark {

/// Standard deviation [m] of ranges about the best straight wall; nullopt when the beams do not
/// determine one. The inverse range of a straight wall is A cos(angle) + B sin(angle), so that the
/// fit is linear. O(n).
/// @param ranges_m  at least three, positive and finite.
std::optional<double> scatter_about_wall_m(std::span<const double> ranges_m,
                                           std::span<const double> angles_rad);

}  // namespace waymark

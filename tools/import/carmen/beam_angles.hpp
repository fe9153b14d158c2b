// SPDX-License-Identifier: BSD-3-Clause
// Beam angles for logs that do not contain them.
#pragma once

#include <optional>
#include <span>

namespace waymark {

struct BeamAngles {
  double first_rad{0.0};
  double step_rad{0.0};
};

/// Conventions for a SICK, which covers 180 degrees from -90 on: the last of 181 or 361 beams is at
/// +90, the last of 180 or 360 beams one step before (as in the logs of the relations benchmark).
/// nullopt for other numbers.
std::optional<BeamAngles> conventional_angles(std::size_t num_beams);

/// Angle of the first beam of a scan that is centred ahead, rounded to whole degrees.
double first_angle_rad(std::size_t num_beams, double step_rad);

/// The field of view, among those of common LiDARs, with which walls are straightest, if it is
/// clearly better than conventional_angles(); else conventional_angles(). nullopt if neither is
/// known: an unusual number of beams, and few walls.
/// @param scans  ranges [m] of scans of num_beams; only finite positive ones are used.
std::optional<BeamAngles> straightest_angles(std::span<const std::span<const double>> scans,
                                             std::size_t num_beams);

}  // namespace waymark

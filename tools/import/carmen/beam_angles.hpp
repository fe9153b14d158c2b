// SPDX-License-Identifier: BSD-3-Clause
// Angles of beams that a log does not say.
#pragma once

#include <optional>
#include <span>

namespace waymark {

struct BeamAngles {
  double first_rad{0.0};
  double step_rad{0.0};
};

/// SICK conventions over 180 degrees from -90: 181 and 361 beams reach +90 with the last one, 180
/// and 360 end one step before (as in the logs of the relations benchmark). nullopt for other
/// numbers.
std::optional<BeamAngles> conventional_angles(std::size_t num_beams);

/// First beam of a scan that looks ahead with its middle, on whole degrees.
double first_angle_rad(std::size_t num_beams, double step_rad);

/// Of the fields of view that LiDARs have, that with which walls are straightest, where it is
/// clearly better than conventional_angles(); these else. nullopt where neither is known: scans
/// with few walls, or none, of an unusual number of beams.
/// @param scans  ranges [m] of scans of num_beams; what is not finite and positive is no range
std::optional<BeamAngles> straightest_angles(std::span<const std::span<const double>> scans,
                                             std::size_t num_beams);

}  // namespace waymark

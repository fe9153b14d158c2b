// SPDX-License-Identifier: BSD-3-Clause
// Which directions of the pose a scan tells.
#pragma once

#include "slam/core/belief/belief.hpp"
#include "slam/core/scan/observability.hpp"

namespace waymark {

/// What the walls of a scan can tell of the pose, as linear functions of (x, y, theta) in the map,
/// in columns. Along a bare wall they leave out what is correlated with the motion along it: one
/// scan knows the wall's direction to a fraction of a degree only, and drawing the rest of it would
/// take the uncertainty along the wall away by and by.
/// @param walls_in_base  of the scan, base frame.
PoseAxes told_axes(const Observability& walls_in_base, const Belief& belief);

}  // namespace waymark

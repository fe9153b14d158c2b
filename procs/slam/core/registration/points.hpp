// SPDX-License-Identifier: BSD-3-Clause
// Ends of a scan's beams.
#pragma once

#include "slam/core/scan/observation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

using Points = std::vector<Eigen::Vector2d>;

/// Ends of all beams, frame: base.
Points points_of(const Observation& observation);

/// At most so many of them, evenly spread.
Points thinned(const Points& points, std::size_t most);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// End points of a scan's beams.
#pragma once

#include "slam/core/scan/observation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

using Points = std::vector<Eigen::Vector2d>;

/// End points of all beams, base frame.
Points points_of(const Observation& observation);

/// At most `most` of the points, evenly spread.
Points thinned(const Points& points, std::size_t most);

}  // namespace waymark

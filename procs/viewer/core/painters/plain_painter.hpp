// SPDX-License-Identifier: BSD-3-Clause
// The bare map, one pixel per cell: walls black, free space white, the rest grey (the paper's
// figure 10).
#pragma once

#include "viewer/core/scene/grid_map.hpp"

namespace waymark::viewer {

/// Grey levels of ROS's map_server.
constexpr uchar kOccupiedGrey = 0;
constexpr uchar kFreeGrey = 254;
constexpr uchar kUnknownGrey = 205;

/// Highest y in the first row. An empty map becomes one unknown pixel.
cv::Mat_<uchar> paint_plain(const GridMap& map, const MapThresholds& thresholds);

}  // namespace waymark::viewer

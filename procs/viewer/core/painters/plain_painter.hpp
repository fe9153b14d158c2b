// SPDX-License-Identifier: BSD-3-Clause
// plain.png: the map alone, one pixel per cell, walls black, free space white, unknown grey (the
// paper's figure 10).
#pragma once

#include "viewer/core/scene/grid_map.hpp"

namespace waymark::viewer {

/// Grey levels of ROS's map_server.
constexpr uchar kOccupiedGrey = 0;
constexpr uchar kFreeGrey = 254;
constexpr uchar kUnknownGrey = 205;

/// The first row has the highest y. An empty map becomes one unknown pixel.
cv::Mat_<uchar> paint_plain(const GridMap& map, const MapThresholds& thresholds);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// scan.png: one scan, its beams coloured by the marker that they hit (the paper's figure 6).
#pragma once

#include "viewer/core/scene/scene.hpp"

namespace waymark::viewer {

/// @return BGR square with the LiDAR in the middle, its x axis pointing up.
cv::Mat paint_scan(const AnnotatedScan& scan, int size_px);

}  // namespace waymark::viewer

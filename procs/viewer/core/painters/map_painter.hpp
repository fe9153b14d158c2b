// SPDX-License-Identifier: BSD-3-Clause
// map.png: the map with paths, markers, health and legend.
#pragma once

#include "viewer/core/page/style.hpp"
#include "viewer/core/scene/scene.hpp"

#include <opencv2/core.hpp>

namespace waymark::viewer {

/// @return BGR, at most style.page_width_px wide.
cv::Mat paint_map(const Scene& scene, const MapPageStyle& style);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Differences from the loaded map or the survey, on map.png.
#pragma once

#include "viewer/core/drawing/view.hpp"
#include "viewer/core/scene/scene.hpp"

#include <opencv2/core.hpp>

#include <span>

namespace waymark::viewer {

/// Markers: a cross where one is missing, a line from the old to the new place of a moved one, a
/// ring around a new one. Walls: a box, dashed where the wall is gone.
void draw_changes(cv::Mat& panel, const View& view, std::span<const MapChange> changes);

}  // namespace waymark::viewer

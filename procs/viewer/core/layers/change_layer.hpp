// SPDX-License-Identifier: BSD-3-Clause
// Differences from the loaded map or the survey, on map.png.
#pragma once

#include "viewer/core/drawing/map_viewport.hpp"
#include "viewer/core/scene/scene.hpp"

#include <opencv2/core.hpp>

#include <span>

namespace waymark::viewer {

/// Markers: a cross where one is missing; for a moved one or one that the survey has elsewhere, a
/// line from a small ring at the old or surveyed place to the present place; a ring around a new
/// one. Walls: a box, dashed where the wall is gone.
void draw_changes(cv::Mat& panel, const MapViewport& view, std::span<const MapChange> changes);

}  // namespace waymark::viewer

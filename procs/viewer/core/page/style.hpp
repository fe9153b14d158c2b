// SPDX-License-Identifier: BSD-3-Clause
// Sizes and distances that the user may choose for map.png.
#pragma once

#include "viewer/core/scene/grid_map.hpp"

namespace waymark::viewer {

struct MapPageStyle {
  MapThresholds thresholds{};  ///< as in map.yaml; the sizes in the heading are measured with them
  int page_width_px{2400};
  int page_height_px{2000};  ///< height for the map, without heading, overview and legend
  int max_strips{8};
  double max_scale_px_per_m{240.0};
  int mark_spacing_px{120};   ///< least spacing along the path, rounded up to 1, 2 or 5 * 10^n m
  double marker_size_m{0.4};  ///< side of the black square
};

}  // namespace waymark::viewer

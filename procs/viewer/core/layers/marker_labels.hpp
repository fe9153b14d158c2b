// SPDX-License-Identifier: BSD-3-Clause
// Places labels with the markers' ids behind their wall, not on free space, without overlap.
#pragma once

#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/page/map_page.hpp"

#include <string>
#include <vector>

namespace waymark::viewer {

struct MarkerLabel {
  int id{kNoMarker};
  std::string text{};
  cv::Point2d marker_px{};  ///< middle of the marker
  cv::Rect2d box_px{};      ///< inside the panel
  LandmarkState state{LandmarkState::kUnknown};
  cv::Scalar colour{palette::kMarker};
};

/// "7", or "7.1" for the second marker with that id; "7 moved" for a moved one.
std::string label_text(const Landmark& landmark);

/// Places the labels of the markers in the view, one after the other, each at the position of least
/// cost. Deterministic.
std::vector<MarkerLabel> place_labels(const std::vector<Landmark>& landmarks, const GridMap& map,
                                      const MapViewport& view, double text_height_px);

cv::Scalar colour_of(LandmarkState state);

void draw_labels(cv::Mat& panel, const std::vector<MarkerLabel>& labels, double text_height_px);

}  // namespace waymark::viewer

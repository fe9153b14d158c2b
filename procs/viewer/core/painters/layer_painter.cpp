// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/painters/layer_painter.hpp"

#include "viewer/core/annotations/map_annotations.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/layers/map_layers.hpp"
#include "viewer/core/layers/marker_labels.hpp"
#include "viewer/core/page/map_page.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>
#include <map>

namespace waymark::viewer {
namespace {

constexpr double kText_px = 18.0;

/// Colour of a cell: strong with an id, faint without.
Colour id_colour(int percent, int marker_id) {
  const cv::Scalar faint_wall = blend(palette::kFree, palette::kOccupied, 0.4);
  if (marker_id >= 0) return to_colour(colour_of_id(marker_id));
  if (percent < 0) return to_colour(palette::kUnknown);
  return to_colour(blend(palette::kFree, faint_wall, std::min(percent, 100) / 100.0));
}

/// Direction (map frame) from a cell towards the open cells around it; 0 when there are none.
double direction_of_open_space_rad(const GridMap& map, cv::Point middle) {
  constexpr int kReach_cells = 8;
  constexpr int kOpenBelow_percent = 50;
  const cv::Rect all{{0, 0}, map.occupancy_percent.size()};
  cv::Point sum{0, 0};
  for (int dy = -kReach_cells; dy <= kReach_cells; ++dy) {
    for (int dx = -kReach_cells; dx <= kReach_cells; ++dx) {
      const cv::Point cell = middle + cv::Point{dx, dy};
      if (!all.contains(cell)) continue;
      const int percent = map.occupancy_percent(cell);
      if (percent >= 0 && percent < kOpenBelow_percent) sum += cv::Point{dx, dy};
    }
  }
  return std::atan2(sum.y, sum.x);
}

/// Groups of neighbouring cells (gaps of up to four cells are bridged) among one id's cells.
std::vector<std::vector<cv::Point>> groups_of(const std::vector<cv::Point>& cells) {
  const cv::Rect box = cv::boundingRect(cells);
  cv::Mat_<uchar> mask(box.size(), uchar{0});
  for (const cv::Point& cell : cells)
    mask(cell - box.tl()) = 1;
  cv::Mat_<uchar> joined;
  cv::dilate(mask, joined, cv::getStructuringElement(cv::MORPH_RECT, {5, 5}));
  cv::Mat_<int> labels;
  const int count = cv::connectedComponents(joined, labels, 8, CV_32S);
  std::vector<std::vector<cv::Point>> groups(static_cast<std::size_t>(count));
  for (const cv::Point& cell : cells)
    groups[static_cast<std::size_t>(labels(cell - box.tl()))].push_back(cell);
  std::erase_if(groups, [](const auto& group) { return group.size() < 2; });
  return groups;
}

}  // namespace

std::vector<Landmark> landmarks_of_cells(const GridMap& map) {
  std::map<int, std::vector<cv::Point>> cells_by_id;
  for (int row = 0; row < map.marker_ids.rows; ++row) {
    for (int column = 0; column < map.marker_ids.cols; ++column) {
      const int id = map.marker_ids(row, column);
      if (id >= 0) cells_by_id[id].emplace_back(column, row);
    }
  }
  std::vector<Landmark> landmarks;
  for (const auto& [id, cells] : cells_by_id) {
    for (const std::vector<cv::Point>& group : groups_of(cells)) {
      cv::Point2d sum{0, 0};
      for (const cv::Point& cell : group)
        sum += cv::Point2d{cell};
      const cv::Point middle{sum * (1.0 / static_cast<double>(group.size()))};
      landmarks.push_back({.id = id,
                           .map_from_marker = {map.cell_centre_m(middle.y, middle.x),
                                               direction_of_open_space_rad(map, middle)},
                           .state = LandmarkState::kConfirmed});
    }
  }
  return landmarks;
}

cv::Mat paint_marker_layer(const GridMap& map, const std::string& title,
                           const MapPageStyle& style) {
  const PageContent content{.map = map, .landmarks = landmarks_of_cells(map)};
  const MapPage layout = lay_out(content, style);
  cv::Mat page{layout.size_px, CV_8UC3, palette::kPage};
  draw_heading(page, layout.heading_px, title, content, layout.strips.front().view.view_from_map,
               style.thresholds);
  if (layout.overview) {
    cv::Mat panel = page(layout.overview->page_px);
    draw_cells(panel, layout.overview->view, map, id_colour);
    draw_strip_marks(page, layout);
  }
  for (const Panel& strip : layout.strips) {
    cv::Mat panel = page(strip.page_px);
    draw_cells(panel, strip.view, map, id_colour);
    auto labels = place_labels(content.landmarks, map, strip.view, kText_px);
    for (MarkerLabel& label : labels)
      label.colour = colour_of_id(label.id);
    draw_labels(panel, labels, kText_px);
    draw_ruler(page, strip);
  }
  return page(cv::Rect{0, 0, page.cols, layout.legend_px.y + kRulerHeight_px / 2}).clone();
}

}  // namespace waymark::viewer

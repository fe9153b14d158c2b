// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/tiled_map.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <cmath>

namespace waymark::viewer {
namespace {

constexpr double kMaxSide_px = 1e6;           // limit of libpng
constexpr std::size_t kMaxCounted = 100'000;  // further tiles that are left out are not counted

bool is_well_formed(const TileLayout& layout, const TileUpdate& update) {
  if (!(layout.resolution_m > 0.0) || !std::isfinite(layout.resolution_m)) return false;
  if (!std::isfinite(layout.origin_x_m) || !std::isfinite(layout.origin_y_m)) return false;
  const auto side = static_cast<std::size_t>(std::max(layout.size_cells, 0));
  return side > 0 && update.occupancy_percent.size() == side * side &&
         update.marker_ids.size() == side * side;
}

}  // namespace

void TiledMap::TileBox::include(std::int64_t x, std::int64_t y) {
  if (last_x < first_x) {
    *this = {x, y, x, y};
    return;
  }
  first_x = std::min(first_x, x);
  first_y = std::min(first_y, y);
  last_x = std::max(last_x, x);
  last_y = std::max(last_y, y);
}

double TiledMap::TileBox::columns(int size_cells) const {
  return static_cast<double>(last_x - first_x + 1) * size_cells;
}

double TiledMap::TileBox::rows(int size_cells) const {
  return static_cast<double>(last_y - first_y + 1) * size_cells;
}

TiledMap::Outcome TiledMap::put(const TileLayout& layout, Timestamp time,
                                const TileUpdate& update) {
  if (!is_well_formed(layout, update)) return Outcome::kMalformed;
  const bool is_another_map = !(layout == layout_);
  TileBox box = is_another_map ? TileBox{} : box_;
  box.include(update.tile_x, update.tile_y);
  const double columns = box.columns(layout.size_cells);
  const double rows = box.rows(layout.size_cells);
  if (columns * rows > static_cast<double>(max_cells_) || std::max(columns, rows) > kMaxSide_px) {
    if (left_out_.size() < kMaxCounted) left_out_.insert({update.tile_x, update.tile_y});
    return Outcome::kTooFarAway;
  }
  if (is_another_map) {
    tiles_.clear();
    left_out_.clear();
  }
  layout_ = layout;
  box_ = box;
  Tile& tile = tiles_[{update.tile_x, update.tile_y}];
  if (!tile.occupancy_percent.empty() && is_older(time, tile.time)) return Outcome::kOlderThanKnown;
  tile.time = time;
  tile.occupancy_percent.assign(update.occupancy_percent.begin(), update.occupancy_percent.end());
  tile.marker_ids.assign(update.marker_ids.begin(), update.marker_ids.end());
  return Outcome::kStored;
}

GridMap TiledMap::grid_of_all_tiles() const {
  GridMap map;
  if (tiles_.empty()) return map;
  const int side = layout_.size_cells;
  const cv::Size size{static_cast<int>(box_.last_x - box_.first_x + 1) * side,
                      static_cast<int>(box_.last_y - box_.first_y + 1) * side};
  map.occupancy_percent = cv::Mat_<schar>(size, schar{kUnknownOccupancy});
  map.marker_ids = cv::Mat_<short>(size, short{-1});
  map.resolution_m = layout_.resolution_m;
  map.origin_m =
      Eigen::Vector2d{layout_.origin_x_m, layout_.origin_y_m} +
      layout_.resolution_m * side *
          Eigen::Vector2d{static_cast<double>(box_.first_x), static_cast<double>(box_.first_y)};
  for (const auto& [index, tile] : tiles_) {
    const int left = static_cast<int>(index.first - box_.first_x) * side;
    const int bottom = static_cast<int>(index.second - box_.first_y) * side;
    for (int row = 0; row < side; ++row) {
      const auto first = static_cast<std::ptrdiff_t>(row) * side;
      std::copy_n(tile.occupancy_percent.begin() + first, side,
                  map.occupancy_percent[bottom + row] + left);
      std::copy_n(tile.marker_ids.begin() + first, side, map.marker_ids[bottom + row] + left);
    }
  }
  return map;
}

GridMap TiledMap::grid() const {
  return crop_to_known(grid_of_all_tiles());
}

GridMap crop_to_known(const GridMap& map) {
  GridMap cropped;
  cropped.resolution_m = map.resolution_m;
  if (map.empty()) return cropped;
  const cv::Rect known = cv::boundingRect(cv::Mat{map.occupancy_percent >= 0});
  if (known.empty()) return cropped;
  cropped.occupancy_percent = map.occupancy_percent(known).clone();
  cropped.marker_ids = map.marker_ids(known).clone();
  cropped.origin_m = map.origin_m + map.resolution_m * Eigen::Vector2d{known.x, known.y};
  return cropped;
}

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/annotations/map_size.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>

namespace waymark::viewer {
namespace {

/// Histogram of the free cells along one axis, in bins one cell wide. The extent reaches from the
/// first to the last bin with at least kStray cells.
class ExtentCounter {
 public:
  void add(double position_m, double resolution_m) {
    ++counts_[static_cast<long>(std::floor(position_m / resolution_m + 1e-6))];
  }

  double extent_cells() const {
    constexpr int kStray = 3;  // a bin with fewer free cells is noise
    long first = 0, last = -1;
    for (const auto& [bin, count] : counts_) {
      if (count < kStray) continue;
      if (last < first) first = bin;
      last = bin;
    }
    return static_cast<double>(last - first + 1);
  }

 private:
  std::map<long, int> counts_;
};

corridor::MapImage image_of(const GridMap& map, const MapThresholds& thresholds) {
  const cv::Size size = map.occupancy_percent.size();
  corridor::MapImage image{size.width, size.height, map.resolution_m, {}};
  image.cells.reserve(static_cast<std::size_t>(size.area()));
  for (const schar percent : map.occupancy_percent) {
    const CellKind kind = kind_of(percent, thresholds);
    image.cells.push_back(kind == CellKind::kFree       ? corridor::Cell::kFree
                          : kind == CellKind::kOccupied ? corridor::Cell::kOccupied
                                                        : corridor::Cell::kUnknown);
  }
  return image;
}

}  // namespace

std::optional<FreeExtent> free_extent(const GridMap& map, const Se2& view_from_map,
                                      const MapThresholds& thresholds) {
  ExtentCounter along, across;
  for (int row = 0; row < map.occupancy_percent.rows; ++row) {
    for (int column = 0; column < map.occupancy_percent.cols; ++column) {
      if (kind_of(map.occupancy_percent(row, column), thresholds) != CellKind::kFree) continue;
      // Relative to the corner of cell (0, 0), so that centres of unrotated cells are mid-bin.
      const Eigen::Vector2d point =
          view_from_map.rotation() * (map.cell_centre_m(row, column) - map.origin_m);
      along.add(point.x(), map.resolution_m);
      across.add(point.y(), map.resolution_m);
    }
  }
  const double length_px = along.extent_cells();
  const double width_px = across.extent_cells();
  if (length_px <= 0.0 || width_px <= 0.0) return std::nullopt;
  return FreeExtent{length_px * map.resolution_m, width_px * map.resolution_m};
}

std::optional<corridor::CorridorLength> corridor_length(const GridMap& map,
                                                        const MapThresholds& thresholds) {
  constexpr double kElongated = 4.0;  // length over width
  constexpr double kMinShare = 0.8;   // area of the corridor over that of all free cells
  constexpr double kMaxCells = 1e6;   // a kilometre of corridor in cells of 5 cm; bounds the time
  const auto free_cells = static_cast<double>(
      std::count_if(map.occupancy_percent.begin(), map.occupancy_percent.end(),
                    [&](int percent) { return kind_of(percent, thresholds) == CellKind::kFree; }));
  if (free_cells > kMaxCells) return std::nullopt;
  try {
    const corridor::CorridorLength length = corridor::measure_corridor(image_of(map, thresholds));
    const bool is_corridor = length.length_px >= kElongated * length.width_px &&
                             length.length_px * length.width_px >= kMinShare * free_cells;
    return is_corridor ? std::optional{length} : std::nullopt;
  } catch (const corridor::NotACorridor&) {
    return std::nullopt;
  }
}

std::string size_text(const GridMap& map, const Se2& view_from_map,
                      const MapThresholds& thresholds) {
  if (const auto length = corridor_length(map, thresholds)) {
    std::string text = fmt::format("corridor {:.2f} m long ({:g} px of {:g} m), {:.2f} m wide",
                                   length->length_m, std::round(10.0 * length->length_px) / 10.0,
                                   map.resolution_m, length->width_px * map.resolution_m);
    for (std::string flag : length->flags) {
      std::replace(flag.begin(), flag.end(), '_', ' ');
      text += ", " + flag;
    }
    return text;
  }
  const auto extent = free_extent(map, view_from_map, thresholds);
  return extent ? fmt::format("free space {:.1f} m x {:.1f} m", extent->length_m, extent->width_m)
                : "no map yet";
}

}  // namespace waymark::viewer

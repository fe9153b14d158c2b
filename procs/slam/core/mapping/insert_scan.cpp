// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/insert_scan.hpp"

#include "slam/core/grid/line.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <vector>

namespace waymark {

namespace {

/// A set of cells: one bit per cell of a rectangle.
class CellSet {
 public:
  /// @param others  cells that the rectangle has to include, too.
  CellSet(std::span<const CellIndex> cells, std::span<const CellIndex> others) {
    if (cells.empty()) return;
    low_ = cells.front();
    CellIndex high = low_;
    for (const auto& some : {cells, others}) {
      for (const CellIndex& cell : some) {
        low_ = {std::min(low_.x, cell.x), std::min(low_.y, cell.y)};
        high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
      }
    }
    width_ = std::int64_t{high.x} - low_.x + 1;
    const std::int64_t height = std::int64_t{high.y} - low_.y + 1;
    is_in_.resize(static_cast<std::size_t>(width_ * height));
    for (const CellIndex& cell : cells)
      is_in_[place_of(cell)] = true;
  }

  /// @param cell  in the rectangle.
  bool contains(CellIndex cell) const { return is_in_[place_of(cell)]; }

 private:
  std::size_t place_of(CellIndex cell) const {
    return static_cast<std::size_t>((std::int64_t{cell.y} - low_.y) * width_ +
                                    (std::int64_t{cell.x} - low_.x));
  }

  CellIndex low_{};
  std::int64_t width_{0};
  std::vector<bool> is_in_{};
};

/// @param count  1 to insert the beams, -1 (modulo 2^32) to erase them.
void count_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base,
                 std::uint32_t count, GridMap& map) {
  const Eigen::Matrix2d rotation = map_from_base.rotation();
  const auto cell_of = [&](const Eigen::Vector2d& in_base) {
    return map.frame.cell_of(rotation * in_base + map_from_base.translation());
  };
  std::vector<CellIndex> start;
  std::vector<CellIndex> hit;
  start.reserve(beams.size());
  hit.reserve(beams.size());
  for (const AnnotatedBeam& annotated : beams) {
    start.push_back(cell_of(annotated.beam.start_in_base));
    hit.push_back(cell_of(annotated.beam.end_in_base));
    OccupancyCell& cell = map.occupancy.edit(hit.back());
    cell.hits += count;
    cell.visits += count;
  }
  const CellSet hits{hit, start};
  TileEditor editor{map.occupancy};
  for (std::size_t i = 0; i < beams.size(); ++i) {
    visit_line(start[i], hit[i], [&](CellIndex cell) {
      if (!hits.contains(cell)) editor.edit(cell).visits += count;
    });
  }
}

}  // namespace

void insert_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map) {
  count_beams(beams, map_from_base, 1, map);
}

void erase_beams(std::span<const AnnotatedBeam> beams, const Se2& map_from_base, GridMap& map) {
  count_beams(beams, map_from_base, ~std::uint32_t{0}, map);
}

std::vector<FacePoint> face_points(const MarkerSighting& sighting, double spacing_m,
                                   double margin_m) {
  const double half_m = 0.5 * sighting.size_m;
  const double reach_m = half_m + margin_m;
  // Symmetric about the centre, so that a mirrored marker has mirrored points.
  const int count = std::max(1, static_cast<int>(std::lround(2.0 * reach_m / spacing_m)));
  std::vector<FacePoint> points;
  points.reserve(static_cast<std::size_t>(count));
  for (int i = 0; i < count; ++i) {
    const double right_m = (i - 0.5 * (count - 1)) * spacing_m;
    points.push_back(
        {sighting.point_at(right_m), std::abs(right_m) < half_m ? sighting.id : kNoMarker});
  }
  return points;
}

void insert_face_points(std::span<const FacePoint> points, double spacing_m,
                        const Se2& map_from_base, GridMap& map) {
  const auto vote = static_cast<float>(spacing_m / map.frame.resolution_m);
  for (const FacePoint& point : points) {
    map.markers.edit(map.frame.cell_of(map_from_base * point.in_base)).vote(point.marker_id, vote);
  }
}

}  // namespace waymark

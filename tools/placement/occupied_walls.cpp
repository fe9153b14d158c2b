// SPDX-License-Identifier: BSD-3-Clause
#include "placement/occupied_walls.hpp"

#include "common/geometry/principal_axes.hpp"

#include <cmath>
#include <utility>

namespace waymark::placement {
namespace {

constexpr double kPatchRadius_m = 0.35;  // a line is fitted to the cells within this distance
constexpr double kLineRatio = 0.1;       // largest variance across a line over that along it
constexpr int kMinCells = 5;
constexpr double kStep = 0.5;  // along a ray [cells]

}  // namespace

OccupiedWalls::OccupiedWalls(PlacedMapImage image)
    : image_{std::move(image)}, patches_(image_.cells.size()) {}

std::optional<std::size_t> OccupiedWalls::first_hit(const Eigen::Vector2d& from_m,
                                                    const Eigen::Vector2d& direction,
                                                    double range_m) const {
  const double step_m = kStep * image_.resolution_m;
  for (double far_m = 0.0; far_m <= range_m; far_m += step_m) {
    const Eigen::Vector2d cell =
        (from_m + far_m * direction - image_.origin_m) / image_.resolution_m;
    const int column = static_cast<int>(std::floor(cell.x()));
    const int row = static_cast<int>(std::floor(cell.y()));
    if (image_.at(column, row) == Cell::kOccupied)
      return static_cast<std::size_t>(row) * image_.width_px + column;
    if (!image_.contains(column, row)) return std::nullopt;
  }
  return std::nullopt;
}

Eigen::Vector2d OccupiedWalls::centre_of(std::size_t cell) const {
  const auto columns = static_cast<std::size_t>(image_.width_px);
  const Eigen::Vector2d place{static_cast<double>(cell % columns) + 0.5,
                              static_cast<double>(cell / columns) + 0.5};
  return image_.origin_m + image_.resolution_m * place;
}

Cell OccupiedWalls::state_at(const Eigen::Vector2d& point_m) const {
  const Eigen::Vector2d cell = (point_m - image_.origin_m) / image_.resolution_m;
  return image_.at(static_cast<int>(std::floor(cell.x())), static_cast<int>(std::floor(cell.y())));
}

const WallPatch& OccupiedWalls::patch(std::size_t cell) const {
  std::optional<WallPatch>& known = patches_[cell];
  if (!known) known = fitted(cell);
  return *known;
}

WallPatch OccupiedWalls::fitted(std::size_t cell) const {
  const auto columns = static_cast<std::size_t>(image_.width_px);
  const int column = static_cast<int>(cell % columns);
  const int row = static_cast<int>(cell / columns);
  const int reach = static_cast<int>(std::ceil(kPatchRadius_m / image_.resolution_m));
  int count = 0;
  Eigen::Vector2d sum = Eigen::Vector2d::Zero();
  Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
  for (int r = -reach; r <= reach; ++r) {
    for (int c = -reach; c <= reach; ++c) {
      const Eigen::Vector2d offset = image_.resolution_m * Eigen::Vector2d{c, r};
      if (offset.norm() > kPatchRadius_m) continue;
      if (image_.at(column + c, row + r) != Cell::kOccupied) continue;
      ++count;
      sum += offset;
      squares += offset * offset.transpose();
    }
  }
  const Eigen::Vector2d mean = sum / count;
  const PrincipalAxes axes = principal_axes(squares / count - mean * mean.transpose());
  WallPatch patch;
  patch.point = centre_of(cell) + mean;
  patch.normal = axes.directions.col(0);
  patch.is_line = count >= kMinCells && axes.values[0] < kLineRatio * axes.values[1];
  return patch;
}

}  // namespace waymark::placement

// SPDX-License-Identifier: BSD-3-Clause
// The walls of an occupancy map: where a beam ends, and which way the wall lies there.
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <vector>

namespace waymark::placement {

enum class CellState : std::uint8_t { kUnknown, kFree, kOccupied };

/// Row 0 is the lowest y, column 0 the lowest x; cells along the map's axes.
struct OccupancyImage {
  int columns{0};
  int rows{0};
  double resolution_m{0.05};
  Eigen::Vector2d origin_m{Eigen::Vector2d::Zero()};  ///< lower left corner of cell (0, 0), map
  std::vector<CellState> cells{};                     ///< row by row

  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < columns && row < rows;
  }

  CellState at(int column, int row) const {
    return contains(column, row) ? cells[static_cast<std::size_t>(row) * columns + column]
                                 : CellState::kUnknown;
  }
};

/// The line that the occupied cells around a place lie on.
struct WallPatch {
  Eigen::Vector2d point{Eigen::Vector2d::Zero()};    ///< mean of the cells, map
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< unit, any sign
  bool is_line{false};                               ///< else a corner, a leg, clutter
};

class OccupiedWalls {
 public:
  explicit OccupiedWalls(OccupancyImage image);

  const OccupancyImage& image() const { return image_; }

  /// Index of the first occupied cell on a ray; nothing where it leaves the known map, or goes
  /// further than `range_m`. O(range / resolution).
  std::optional<std::size_t> first_hit(const Eigen::Vector2d& from_m,
                                       const Eigen::Vector2d& direction, double range_m) const;

  Eigen::Vector2d centre_of(std::size_t cell) const;

  CellState state_at(const Eigen::Vector2d& point_m) const;

  /// Of an occupied cell; fitted at the first call.
  const WallPatch& patch(std::size_t cell) const;

 private:
  WallPatch fitted(std::size_t cell) const;

  OccupancyImage image_;
  mutable std::vector<std::optional<WallPatch>> patches_{};
};

}  // namespace waymark::placement

// SPDX-License-Identifier: BSD-3-Clause
// The walls of an occupancy map: ray casting, and the line of the wall at a cell.
#pragma once

#include "common/corridor/map_image.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace waymark::placement {

using corridor::Cell;

/// An occupancy image with its position in the map frame.
struct PlacedMapImage : corridor::MapImage {
  Eigen::Vector2d origin_m{Eigen::Vector2d::Zero()};  ///< lower left corner of cell (0, 0), map
};

/// The line that the occupied cells around a place lie on.
struct WallPatch {
  Eigen::Vector2d point{Eigen::Vector2d::Zero()};    ///< mean of the cells, map frame
  Eigen::Vector2d normal{Eigen::Vector2d::UnitX()};  ///< unit vector of either sign, map frame
  bool is_line{false};                               ///< false: a corner, a leg, clutter
};

class OccupiedWalls {
 public:
  explicit OccupiedWalls(PlacedMapImage image);

  const PlacedMapImage& image() const { return image_; }

  /// Index of the first occupied cell on a ray; nothing if the ray leaves the image or exceeds
  /// `range_m`. O(range / resolution).
  std::optional<std::size_t> first_hit(const Eigen::Vector2d& from_m,
                                       const Eigen::Vector2d& direction, double range_m) const;

  Eigen::Vector2d centre_of(std::size_t cell) const;

  Cell state_at(const Eigen::Vector2d& point_m) const;

  /// Line at an occupied cell; fitted at the first call.
  const WallPatch& patch(std::size_t cell) const;

 private:
  WallPatch fitted(std::size_t cell) const;

  PlacedMapImage image_;
  mutable std::vector<std::optional<WallPatch>> patches_{};
};

}  // namespace waymark::placement

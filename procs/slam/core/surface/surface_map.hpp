// SPDX-License-Identifier: BSD-3-Clause
// Where walls are, to better than a cell: the moments of the points that beams hit.
#pragma once

#include "slam/core/grid/grid_frame.hpp"
#include "slam/core/grid/sparse_tile.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <optional>
#include <vector>

namespace waymark {

/// Count, sums and sums of products of the points in a cell, in cells from the cell's centre.
struct SurfaceCell {
  float count{0.0F};
  float x{0.0F};
  float y{0.0F};
  float xx{0.0F};
  float xy{0.0F};
  float yy{0.0F};
};

using SurfaceCells = TileMap<SurfaceCell, SparseTile<SurfaceCell>>;

/// A piece of wall: the line fitted to the points in a square of cells. Points that do not lie on a
/// line (corners, legs of tables) are a clump: a place, but no direction.
struct Surface {
  Eigen::Vector2d point_in_map{Eigen::Vector2d::Zero()};    ///< mean of the points
  Eigen::Vector2d normal_in_map{Eigen::Vector2d::UnitX()};  ///< unit; its sign means nothing
  double count{0.0};                                        ///< points that it was fitted to
  double across_m2{0.0};                                    ///< variance of the points across it
  double normal_rad2{0.0};                                  ///< variance of the normal's direction
  double along_m2{0.0};                                     ///< the same along it
  bool is_line{true};                                       ///< else a clump
};

/// Copies share the tiles that neither has edited since.
class SurfaceMap {
 public:
  explicit SurfaceMap(const GridFrame& frame) : frame_{frame} {}

  void add(const Eigen::Vector2d& point_in_map);

  /// The surface through the cells around a point; nothing where too little is mapped. Moments add
  /// up exactly over cells, so a wall along a border between cells is not split.
  /// @param reach_m  how far off the surface may be; small reaches are tried first, and a line is
  /// preferred to a nearer clump: what has no direction holds a robot back along a bare wall.
  std::optional<Surface> near(const Eigen::Vector2d& point_in_map, double reach_m) const;

 private:
  friend class SurfaceFinder;

  bool looks_far(double reach_m) const;
  std::optional<Surface> close_to(CellIndex middle) const;
  std::optional<Surface> line_or(const std::optional<Surface>& nearer, CellIndex middle,
                                 int reach) const;

  GridFrame frame_;
  SurfaceCells cells_{};
};

/// SurfaceMap::near() for the points of a scan, again and again while the scan is moved about: what
/// was found is kept for as long as a point stays in its cell. The map must not change meanwhile.
class SurfaceFinder {
 public:
  SurfaceFinder(const SurfaceMap& map, std::size_t num_points) : map_{map}, found_(num_points) {}

  const std::optional<Surface>& near(std::size_t point, const Eigen::Vector2d& point_in_map,
                                     double reach_m);

 private:
  struct Found {
    std::optional<CellIndex> middle{};  ///< nothing: not looked for yet
    std::optional<Surface> close{};
    bool has_looked_far{false};
    std::optional<Surface> far{};
  };

  const SurfaceMap& map_;
  std::vector<Found> found_;
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Walls as a grid of normal distributions (NDT; Biber and Strasser 2003).
#pragma once

#include <Eigen/Core>

#include <cstdint>
#include <unordered_map>
#include <vector>

namespace waymark {

inline constexpr int kNoKeyframe = -1;  ///< of points of a map without keyframes

/// Distribution of the points of one cell.
struct NdtCell {
  Eigen::Vector2d mean{Eigen::Vector2d::Zero()};
  Eigen::Vector2d normal{
      Eigen::Vector2d::UnitX()};    ///< direction of least variance; unit, any sign
  double across_m2{0.0};            ///< variance along `normal`
  double along_m2{0.0};             ///< variance at right angles to it
  int count{0};                     ///< points
  int first_keyframe{kNoKeyframe};  ///< the points came from keyframes in [first, last]
  int last_keyframe{kNoKeyframe};
  bool is_line{false};   ///< a piece of wall; else a corner, a table leg or clutter
  bool is_thick{false};  ///< thicker than a wall that is seen with range noise
};

/// Sums of the points of one cell, relative to its centre.
struct NdtCellSums {
  int column{0};
  int row{0};
  double count{0.0};
  Eigen::Vector2d sum_m{Eigen::Vector2d::Zero()};
  Eigen::Vector3d squares_m2{Eigen::Vector3d::Zero()};  ///< xx, xy, yy
};

/// Square cells of side `2 spacing` whose centres are `spacing` apart: each point is added to four
/// overlapping cells, but compared with the one with the nearest centre only. So the cost jumps
/// little where a point changes from cell to cell.
///
/// A door's jamb is shallower than a cell, whose distribution hides it. So a divided map has the
/// same distributions in cells a few times smaller, too: its parts, which replace thick cells.
class NdtMap {
 public:
  enum class Cells { kWhole, kDivided };

  explicit NdtMap(double spacing_m, Cells cells = Cells::kWhole)
      : spacing_m_{spacing_m}, is_divided_{cells == Cells::kDivided} {}

  /// @param keyframe  the one that observed the point; kNoKeyframe: none.
  /// @param weight    number of points that this point counts as.
  void add(const Eigen::Vector2d& point, int keyframe, double weight = 1.0);

  /// Column and row of a cell, packed.
  using Key = std::uint64_t;

  static Key key(int column, int row);

  /// The cell whose centre is nearest.
  Key key_at(const Eigen::Vector2d& point) const { return key_at(point, spacing_m_); }

  /// The part whose centre is nearest.
  Key part_at(const Eigen::Vector2d& point) const { return key_at(point, part_spacing_m()); }

  /// The cell that a part belongs to: the one whose centre is nearest to all of the part.
  static Key cell_of_part(Key part);

  /// The distribution of a cell; nullptr if it has too few points.
  /// @param point_variance_m2  variance of points across a wall: prior of a cell with few points.
  const NdtCell* at(Key key, double point_variance_m2) const;

  /// Where the cell is thick, the distribution of the part, unless that has too few points; else
  /// the cell's, as of a map that is not divided.
  const NdtCell* at_part(Key part, double point_variance_m2) const;

  const NdtCell* at(const Eigen::Vector2d& point, double point_variance_m2) const {
    return is_divided_ ? at_part(part_at(point), point_variance_m2)
                       : at(key_at(point), point_variance_m2);
  }

  bool is_divided() const { return is_divided_; }

  /// Frees the memory of parts that at_part() does not use with this variance. No point may be
  /// added after that.
  void drop_unused_parts(double point_variance_m2);

  double spacing_m() const { return spacing_m_; }

  /// Every cell, in order of (column, row).
  std::vector<NdtCellSums> sums() const;

  /// Adds the points of one cell.
  void add(const NdtCellSums& sums);

 private:
  static constexpr double kStale = -1.0;  ///< no fit, or points were added since
  static constexpr int kParts = 3;        ///< along a side; odd, so that no part lies in two cells

  struct Cell {
    double count{0.0};
    Eigen::Vector2d sum{Eigen::Vector2d::Zero()};  ///< about the cell's centre
    double xx{0.0};
    double xy{0.0};
    double yy{0.0};
    NdtCell distribution{};
    double fitted_with_m2{kStale};  ///< point_variance_m2 of the fit of `distribution`
  };

  using CellMap = std::unordered_map<Key, Cell>;  ///< no result depends on its order

  static Key key_at(const Eigen::Vector2d& point, double spacing_m);
  static void add(const Eigen::Vector2d& point, int keyframe, double weight, double spacing_m,
                  CellMap& cells);
  static const NdtCell* fitted(Key key, double point_variance_m2, double spacing_m, CellMap& cells);

  double part_spacing_m() const { return spacing_m_ / kParts; }

  double spacing_m_;
  bool is_divided_;
  mutable CellMap cells_{};
  mutable CellMap parts_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Correlative scan matching: the global optimum in a window, without an initial guess near it.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/grid/cell_index.hpp"
#include "slam/core/grid/grid_frame.hpp"

#include <Eigen/Core>

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace waymark {

/// Window of a search about its guess: a square along the submap's axes, and headings.
struct SearchWindow {
  double half_width_m{1.0};
  double half_turn_rad{0.5};  ///< pi or more: the full circle
};

/// A pose at which a scan fits.
struct SearchMatch {
  Se2 submap_from_base{};
  double score{0.0};  ///< mean field value over the scan's points, 0..1
};

/// Smoothed occupancy of a submap: 1 in the cell of a point, falling off like a Gaussian, as bytes
/// on a dense grid; with sliding maxima over 2, 4, 8, ... cells as upper bounds for a search.
/// Sources: Olson, "Real-time correlative scan matching" (2009), the score; Hess et al., "Real-time
/// loop closure in 2D LIDAR SLAM" (2016), section V, the branch and bound.
///
/// Immutable after construction, so that threads may share it.
class CorrelativeField {
 public:
  static constexpr double kResolution_m = 0.05;  ///< default side of a cell

  /// @param points_in_submap  any number. Points that are not finite, or more than 1024 cells in x
  ///                          or y from the median, are ignored: that bounds memory (7 levels of
  ///                          at most 4.6 MB each while sigma is about a cell).
  /// @param sigma_m           standard deviation of the fall-off, cut at three of them.
  explicit CorrelativeField(std::span<const Eigen::Vector2d> points_in_submap,
                            double resolution_m = kResolution_m, double sigma_m = kResolution_m);

  /// Field of a whole map: cells and sigma are as large as needed to include every point.
  static CorrelativeField of_map(std::span<const Eigen::Vector2d> points);

  /// Mean field value at the points, 0..1; outside the field, and for points that are not finite,
  /// the value is 0. No points: 0. O(points).
  double score(std::span<const Eigen::Vector2d> points_in_base, const Se2& submap_from_base) const;

  /// The best match in the window with a score above 0 and of at least `min_score`, if any. It is
  /// the global maximum over the candidates: the guess, moved by whole cells along the submap's
  /// axes and turned by steps that move the farthest point by one cell. Among equal scores (along
  /// a bare corridor) it is the one with the fewest cells and steps from the guess, by the sum of
  /// their squares. Deterministic.
  ///
  /// @param guess  submap_from_base, finite.
  std::optional<SearchMatch> best(std::span<const Eigen::Vector2d> points_in_base, const Se2& guess,
                                  const SearchWindow& window, double min_score) const;

  /// The runner-up: the best match at least `apart_m` or at least `apart_rad` away from `other`.
  /// Choose these larger than the width of the peak (3 sigma): otherwise the result lies on the
  /// flank of the same peak.
  std::optional<SearchMatch> best_apart_from(const Se2& other, double apart_m, double apart_rad,
                                             std::span<const Eigen::Vector2d> points_in_base,
                                             const Se2& guess, const SearchWindow& window,
                                             double min_score) const;

 private:
  class Search;

  void draw(std::span<const Eigen::Vector2d> points, double sigma_m);
  void build_pyramid();
  /// Sum over `cells` of the level's bytes, all cells moved by `offset`.
  int sum(std::span<const CellIndex> cells, CellIndex offset, int level) const;

  GridFrame frame_{};
  int width_{0};   ///< cells; 0 for an empty field
  int height_{0};  ///< cells
  /// Level l, row by row: the maximum of the field over [x, x + 2^l) x [y, y + 2^l).
  std::vector<std::vector<std::uint8_t>> levels_{};
};

}  // namespace waymark

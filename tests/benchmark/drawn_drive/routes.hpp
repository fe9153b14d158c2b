// SPDX-License-Identifier: BSD-3-Clause
// Ways through a building.
#pragma once

#include "drawn_drive/building.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark::drawn {

class Routes {
 public:
  explicit Routes(const Building& building);

  /// Where one can get to from anywhere.
  Eigen::Vector2d place(Random& random) const;

  /// Smooth, a point each 0.25 m or so, away from walls.
  std::vector<Eigen::Vector2d> way(const Eigen::Vector2d& from, const Eigen::Vector2d& to) const;

  /// From the nearest wall; 0 in it.
  double clearance_m(const Eigen::Vector2d& place) const;

 private:
  int node_at(const Eigen::Vector2d& place) const;
  Eigen::Vector2d place_of(int node) const;
  bool is_open(int node) const;
  std::vector<int> neighbours(int node) const;

  int columns_;                     ///< of cells
  std::vector<float> clearance_m_;  ///< of cells
  int node_columns_;
  int node_rows_;
  std::vector<int> reachable_{};  ///< nodes of the largest part
};

}  // namespace waymark::drawn

// SPDX-License-Identifier: BSD-3-Clause
// Buildings drawn at random, as cells that are walls or free.
#pragma once

#include "common/random/random.hpp"

#include <Eigen/Core>

#include <string>
#include <vector>

namespace waymark::drawn {

class Building {
 public:
  static constexpr double kCell_m = 0.05;

  /// Solid; what is carved is free.
  Building(double width_m, double height_m);

  static std::vector<std::string> kinds();

  /// `office` (rooms and clutter around two loops), `grid` (four blocks of rooms), `long` (two
  /// blocks of 60 to 80 m), `bare` (one block of 70 to 90 m, hardly a door), `hall`, `outdoors`,
  /// `lab` (four small blocks full of furniture), `campus` (six blocks of 30 to 60 m), `maze` (7 m
  /// x 7 m of rooms of 1.4 m).
  /// @throws std::invalid_argument  of another kind.
  static Building draw(const std::string& kind, Random& random);

  void carve(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
  void fill(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m);
  void fill_disc(const Eigen::Vector2d& centre_m, double radius_m);

  /// Along a ray; `most_m` if there is no wall within.
  double range_m(const Eigen::Vector2d& from_m, double direction_rad, double most_m) const;

  bool is_wall(int column, int row) const;

  int columns() const { return columns_; }

  int rows() const { return rows_; }

 private:
  void set(const Eigen::Vector2d& low_m, const Eigen::Vector2d& high_m, bool is_wall);

  int columns_;
  int rows_;
  std::vector<bool> walls_;
};

}  // namespace waymark::drawn

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/surface/surface_map.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kReach = 1;           // [cell] the square has 2 kReach + 1 of them along each side
constexpr int kSecondReach = 2;     // [cell] when the smaller square says too little
constexpr double kMinPoints = 4.0;  // fewer do not make a line
constexpr double kMaxThickness = 0.45;  // [cell] standard deviation across the line
constexpr double kMinElongation = 2.0;  // of the line: length over thickness

/// Sums over a square of cells, in cells from the centre of its middle cell.
struct Moments {
  double count{0.0};
  Eigen::Vector2d sum{Eigen::Vector2d::Zero()};
  Eigen::Matrix2d squares{Eigen::Matrix2d::Zero()};

  void add(const SurfaceCell& cell, double dx, double dy) {
    const double n = cell.count;
    count += n;
    sum.x() += cell.x + n * dx;
    sum.y() += cell.y + n * dy;
    squares(0, 0) += cell.xx + 2.0 * dx * cell.x + n * dx * dx;
    squares(0, 1) += cell.xy + dx * cell.y + dy * cell.x + n * dx * dy;
    squares(1, 1) += cell.yy + 2.0 * dy * cell.y + n * dy * dy;
  }
};

Moments moments_around(const TileMap<SurfaceCell>& cells, CellIndex middle, int reach) {
  Moments moments;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const SurfaceCell& cell = cells[{middle.x + dx, middle.y + dy}];
      if (cell.count > 0.0F) moments.add(cell, dx, dy);
    }
  }
  return moments;
}

/// Line through the points; in cells from the middle.
std::optional<Surface> fit(const Moments& moments) {
  if (moments.count < kMinPoints) return std::nullopt;
  const Eigen::Vector2d mean = moments.sum / moments.count;
  const double xx = moments.squares(0, 0) / moments.count - mean.x() * mean.x();
  const double xy = moments.squares(0, 1) / moments.count - mean.x() * mean.y();
  const double yy = moments.squares(1, 1) / moments.count - mean.y() * mean.y();
  const double half_trace = 0.5 * (xx + yy);
  const double root = std::hypot(0.5 * (xx - yy), xy);
  const double thickness = std::sqrt(std::max(0.0, half_trace - root));
  const double length = std::sqrt(half_trace + root);
  if (thickness > kMaxThickness || length < kMinElongation * thickness) return std::nullopt;
  const double along_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
  return Surface{mean, {-std::sin(along_rad), std::cos(along_rad)}, moments.count};
}

}  // namespace

void SurfaceMap::add(const Eigen::Vector2d& point_in_map) {
  const CellIndex index = frame_.cell_of(point_in_map);
  const Eigen::Vector2f p =
      ((point_in_map - frame_.centre_of(index)) / frame_.resolution_m).cast<float>();
  SurfaceCell& cell = cells_.edit(index);
  cell.count += 1.0F;
  cell.x += p.x();
  cell.y += p.y();
  cell.xx += p.x() * p.x();
  cell.xy += p.x() * p.y();
  cell.yy += p.y() * p.y();
}

std::optional<Surface> SurfaceMap::near(const Eigen::Vector2d& point_in_map) const {
  const CellIndex middle = frame_.cell_of(point_in_map);
  std::optional<Surface> surface = fit(moments_around(cells_, middle, kReach));
  if (!surface) surface = fit(moments_around(cells_, middle, kSecondReach));
  if (surface) {
    surface->point_in_map = frame_.centre_of(middle) + frame_.resolution_m * surface->point_in_map;
  }
  return surface;
}

}  // namespace waymark

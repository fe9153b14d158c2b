// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/surface/surface_map.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kReaches[]{1, 2, 4};      // [cell] squares of 2 reach + 1 cells along each side
constexpr int kAlwaysTried = 2;         // [cell]
constexpr double kMinPoints = 4.0;      // fewer do not make a line
constexpr double kMaxThickness = 0.45;  // [cell] standard deviation across the line
constexpr double kMinLength = 0.6;  // [cell] standard deviation along it; shorter is range noise
constexpr double kMinElongation = 3.0;  // of the line: length over thickness
constexpr double kCellVariance = 1e-3;  // [cell^2] points are never known better

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

/// In cells from the middle.
std::optional<Surface> fit(const Moments& moments) {
  if (moments.count < kMinPoints) return std::nullopt;
  const Eigen::Vector2d mean = moments.sum / moments.count;
  const double xx = moments.squares(0, 0) / moments.count - mean.x() * mean.x();
  const double xy = moments.squares(0, 1) / moments.count - mean.x() * mean.y();
  const double yy = moments.squares(1, 1) / moments.count - mean.y() * mean.y();
  const double half_trace = 0.5 * (xx + yy);
  const double root = std::hypot(0.5 * (xx - yy), xy);
  Surface surface;
  surface.point_in_map = mean;
  surface.count = moments.count;
  surface.across_m2 = std::max(0.0, half_trace - root) + kCellVariance;
  const double along_m2 = half_trace + root + kCellVariance;
  surface.normal_rad2 = surface.across_m2 / (moments.count * along_m2);
  surface.along_m2 = along_m2;
  surface.is_line = surface.across_m2 <= kMaxThickness * kMaxThickness &&
                    along_m2 >= kMinLength * kMinLength &&
                    along_m2 >= kMinElongation * kMinElongation * surface.across_m2;
  // Eigenvector of the smaller eigenvalue.
  const double along_x = 0.5 * (xx - yy) + root;
  surface.normal_in_map = Eigen::Vector2d{-xy, along_x};
  if (0.5 * (xx - yy) < 0.0) surface.normal_in_map = {root - 0.5 * (xx - yy), -xy};
  const double norm = surface.normal_in_map.norm();
  surface.normal_in_map =
      norm > 0.0 ? Eigen::Vector2d{surface.normal_in_map / norm} : Eigen::Vector2d::UnitX();
  return surface;
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

bool SurfaceMap::looks_far(double reach_m) const {
  return reach_m > kAlwaysTried * frame_.resolution_m;
}

std::optional<Surface> SurfaceMap::near(CellIndex middle, bool looks_far) const {
  std::optional<Surface> surface;
  for (const int reach : kReaches) {
    if (reach > kAlwaysTried && !looks_far) break;
    const auto here = fit(moments_around(cells_, middle, reach));
    if (!here) continue;
    if (here->is_line || !surface) surface = here;
    if (here->is_line) break;
  }
  if (!surface) return std::nullopt;
  const double cell_m2 = frame_.resolution_m * frame_.resolution_m;
  surface->point_in_map = frame_.centre_of(middle) + frame_.resolution_m * surface->point_in_map;
  surface->across_m2 *= cell_m2;
  surface->along_m2 *= cell_m2;
  return surface;
}

const std::optional<Surface>& SurfaceFinder::near(std::size_t point,
                                                  const Eigen::Vector2d& point_in_map,
                                                  double reach_m) {
  Found& found = found_[point];
  const CellIndex middle = map_.frame_.cell_of(point_in_map);
  const bool looks_far = map_.looks_far(reach_m);
  if (!found.is_known || found.middle != middle || found.looks_far != looks_far)
    found = {true, looks_far, middle, map_.near(middle, looks_far)};
  return found.surface;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/surface/surface_map.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// [cell] Squares have 2 reach + 1 cells along each side.
constexpr int kCloseReach = 2;
constexpr int kFarReach = 4;
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

Moments moments_around(const SurfaceCells& cells, CellIndex middle, int reach) {
  Moments moments;
  visit_touched_around(cells, middle, reach, [&](CellIndex index, const SurfaceCell& cell) {
    moments.add(cell, index.x - middle.x, index.y - middle.y);
  });
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
  const double half_difference = 0.5 * (xx - yy);
  const double root = std::sqrt(half_difference * half_difference + xy * xy);
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
  const double along_x = half_difference + root;
  surface.normal_in_map = Eigen::Vector2d{-xy, along_x};
  if (half_difference < 0.0) surface.normal_in_map = {root - half_difference, -xy};
  const double norm = surface.normal_in_map.norm();
  surface.normal_in_map =
      norm > 0.0 ? Eigen::Vector2d{surface.normal_in_map / norm} : Eigen::Vector2d::UnitX();
  return surface;
}

bool is_line(const std::optional<Surface>& surface) {
  return surface && surface->is_line;
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
  return reach_m > kCloseReach * frame_.resolution_m;
}

std::optional<Surface> SurfaceMap::near(const Eigen::Vector2d& point_in_map, double reach_m) const {
  const CellIndex middle = frame_.cell_of(point_in_map);
  const std::optional<Surface> close = close_to(middle);
  return looks_far(reach_m) && !is_line(close) ? line_or(close, middle, kFarReach) : close;
}

std::optional<Surface> SurfaceMap::close_to(CellIndex middle) const {
  std::optional<Surface> surface;
  for (int reach = 1; reach <= kCloseReach && !is_line(surface); ++reach)
    surface = line_or(surface, middle, reach);
  return surface;
}

/// What is within the reach if it is a line, or if there is nothing nearer.
std::optional<Surface> SurfaceMap::line_or(const std::optional<Surface>& nearer, CellIndex middle,
                                           int reach) const {
  std::optional<Surface> surface = fit(moments_around(cells_, middle, reach));
  if (!surface || (nearer && !surface->is_line)) return nearer;
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
  if (!found.middle || *found.middle != middle) {
    // Neighbours in a scan often end in the same cell.
    const bool is_known = point > 0 && found_[point - 1].middle == middle;
    found = is_known ? found_[point - 1] : Found{middle, map_.close_to(middle)};
  }
  if (is_line(found.close) || !map_.looks_far(reach_m)) return found.close;
  if (!found.has_looked_far) {
    found.far = map_.line_or(found.close, middle, kFarReach);
    found.has_looked_far = true;
  }
  return found.far;
}

}  // namespace waymark

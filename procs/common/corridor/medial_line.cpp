// SPDX-License-Identifier: BSD-3-Clause
#include "common/corridor/medial_line.hpp"

#include "common/corridor/not_a_corridor.hpp"
#include "common/geometry/principal_axes.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark::corridor {
namespace {

using Eigen::Vector2d;

// Lengths are in corridor widths where possible, so that little depends on the size of a cell.
constexpr double kSpacing = 1.0 / 8.0;  // between slices
constexpr double kSmoothing = 1.5;      // half window of the local fit: removes noise, keeps bends
constexpr double kExtension = 1.0;      // how far slices are tried beyond the line's ends
constexpr double kWidthTolerance = 0.15;   // largest deviation of an inlier's width from the median
constexpr double kReach = 1.5;             // how far a slice extends to each side, at most
constexpr double kWidthRounding_px = 2.0;  // rounding of a width, never an outlier
constexpr double kSpeck_px = 3.0;          // a shorter break in a slice is a false cell, not a wall
constexpr std::size_t kMinSlices = 5;
constexpr std::size_t kMinCells = 50;

/// A slice across the corridor.
struct Slice {
  double at_px{};  ///< its place along the line found so far
  Vector2d middle_px{};
  double width_px{};
};

double median_width(std::vector<Slice> slices) {
  const auto middle = slices.begin() + static_cast<std::ptrdiff_t>(slices.size() / 2);
  std::nth_element(slices.begin(), middle, slices.end(),
                   [](const Slice& a, const Slice& b) { return a.width_px < b.width_px; });
  return middle->width_px;
}

/// Slices of about the median width. @throws NotACorridor if they are too few.
std::vector<Slice> inliers(const std::vector<Slice>& slices, double tolerance) {
  std::vector<Slice> kept;
  if (!slices.empty()) {
    const double width_px = median_width(slices);
    for (const Slice& slice : slices) {
      if (std::abs(slice.width_px - width_px) <= std::max(kWidthRounding_px, tolerance * width_px))
        kept.push_back(slice);
    }
  }
  if (kept.size() < kMinSlices)
    throw NotACorridor{"the free space is not a corridor: too few slices of equal width"};
  return kept;
}

/// Middle of the corridor at `at_px` by a weighted quadratic fit to the slices near it.
Vector2d local_fit(const std::vector<Slice>& slices, double at_px, double half_window_px) {
  std::vector<std::pair<double, const Slice*>> near;
  for (const Slice& slice : slices) {
    const double distance = std::abs(slice.at_px - at_px) / half_window_px;
    if (distance < 1.0) near.emplace_back(std::pow(1.0 - std::pow(distance, 3), 3), &slice);
  }
  if (near.size() < kMinSlices) return local_fit(slices, at_px, 2.0 * half_window_px);
  Eigen::Matrix3d normal = Eigen::Matrix3d::Zero();
  Eigen::Matrix<double, 2, 3> moments = Eigen::Matrix<double, 2, 3>::Zero();
  for (const auto& [weight, slice] : near) {
    const double u = (slice->at_px - at_px) / half_window_px;
    const Eigen::Vector3d terms{1.0, u, u * u};
    normal += weight * terms * terms.transpose();
    moments += weight * slice->middle_px * terms.transpose();
  }
  return moments * normal.inverse().col(0);
}

std::vector<Vector2d> smoothed(const std::vector<Slice>& slices, double width_px) {
  std::vector<Vector2d> points;
  const double spacing_px = kSpacing * width_px;
  for (double at_px = slices.front().at_px; at_px <= slices.back().at_px; at_px += spacing_px)
    points.push_back(local_fit(slices, at_px, kSmoothing * width_px));
  return points;
}

/// Middles of the region's cells in bins along the principal axis.
std::vector<Slice> slices_across_axis(const std::vector<Vector2d>& region) {
  const Axis axis = principal_axis(region);
  const auto along = [&axis](const Vector2d& cell) {
    return (cell - axis.centre_px).dot(axis.direction);
  };
  double low = 0.0;
  double high = 0.0;
  for (const Vector2d& cell : region) {
    low = std::min(low, along(cell));
    high = std::max(high, along(cell));
  }
  const double rough_width_px = static_cast<double>(region.size()) / (high - low + 1.0);
  const double bin_px = std::max(1.0, kSpacing * rough_width_px);
  std::vector<Slice> bins(static_cast<std::size_t>((high - low) / bin_px) + 1);
  for (const Vector2d& cell : region) {
    Slice& bin = bins[static_cast<std::size_t>((along(cell) - low) / bin_px)];
    bin.middle_px += cell;
    bin.width_px += 1.0;
  }
  std::vector<Slice> filled;
  for (std::size_t i = 0; i < bins.size(); ++i) {
    if (bins[i].width_px > 0.0)
      filled.push_back({(static_cast<double>(i) + 0.5) * bin_px,
                        bins[i].middle_px / bins[i].width_px, bins[i].width_px / bin_px});
  }
  return filled;
}

/// Length of the free space from a point in a direction [px]; breaks up to kSpeck_px do not end it.
double free_reach(const MapImage& map, const Vector2d& from_px, const Vector2d& direction,
                  double limit_px) {
  constexpr double kStep_px = 0.25;
  double reach_px = 0.0;
  for (double at_px = 0.0; at_px <= limit_px && at_px <= reach_px + kSpeck_px; at_px += kStep_px) {
    const Vector2d place = from_px + at_px * direction;
    if (map.at(static_cast<int>(std::lround(place.x())),
               static_cast<int>(std::lround(place.y()))) == Cell::kFree)
      reach_px = at_px;
  }
  return reach_px;
}

std::vector<Slice> slices_across_line(const MapImage& map, const std::vector<Vector2d>& line,
                                      double width_px) {
  const double spacing_px = kSpacing * width_px;
  const auto extra = static_cast<std::ptrdiff_t>(kExtension / kSpacing);
  const auto last = static_cast<std::ptrdiff_t>(line.size()) - 1;
  std::vector<Slice> slices;
  double at_px = 0.0;
  for (std::ptrdiff_t i = -extra; i <= last + extra; ++i) {
    const auto near = static_cast<std::size_t>(std::clamp<std::ptrdiff_t>(i, 1, last - 1));
    const Vector2d step = (line[near + 1] - line[near - 1]) / 2.0;
    const Vector2d place =
        line[near] + static_cast<double>(i - static_cast<std::ptrdiff_t>(near)) * step;
    const Vector2d across{-step.y() / step.norm(), step.x() / step.norm()};
    const double left_px = free_reach(map, place, across, kReach * width_px);
    const double right_px = free_reach(map, place, -across, kReach * width_px);
    if (left_px + right_px > 0.0)
      slices.push_back({at_px, place + 0.5 * (left_px - right_px) * across, left_px + right_px});
    at_px += spacing_px;
  }
  return slices;
}

}  // namespace

std::vector<Vector2d> largest_free_region(const MapImage& map) {
  std::vector<bool> seen(map.cells.size(), false);
  std::vector<std::size_t> largest;
  const auto width = static_cast<std::size_t>(map.width_px);
  for (std::size_t seed = 0; seed < map.cells.size(); ++seed) {
    if (seen[seed] || map.cells[seed] != Cell::kFree) continue;
    std::vector<std::size_t> region{seed};
    seen[seed] = true;
    for (std::size_t next = 0; next < region.size(); ++next) {
      const int x = static_cast<int>(region[next] % width);
      const int y = static_cast<int>(region[next] / width);
      for (const auto& [dx, dy] : {std::pair{1, 0}, {-1, 0}, {0, 1}, {0, -1}}) {
        if (map.at(x + dx, y + dy) != Cell::kFree) continue;
        const std::size_t cell = static_cast<std::size_t>(y + dy) * width + (x + dx);
        if (seen[cell]) continue;
        seen[cell] = true;
        region.push_back(cell);
      }
    }
    if (region.size() > largest.size()) largest.swap(region);
  }
  std::vector<Vector2d> centres;
  centres.reserve(largest.size());
  for (const std::size_t cell : largest)
    centres.emplace_back(static_cast<double>(cell % width), static_cast<double>(cell / width));
  return centres;
}

Axis principal_axis(const std::vector<Vector2d>& points) {
  Vector2d sum = Vector2d::Zero();
  for (const Vector2d& point : points)
    sum += point;
  const Vector2d centre = sum / static_cast<double>(points.size());
  Eigen::Matrix2d spread = Eigen::Matrix2d::Zero();
  for (const Vector2d& point : points)
    spread += (point - centre) * (point - centre).transpose();
  Vector2d direction = principal_axes(spread).directions.col(1);
  Eigen::Index main{};
  direction.cwiseAbs().maxCoeff(&main);
  if (direction[main] < 0.0) direction = -direction;
  return {centre, direction};
}

MedialLine medial_line(const MapImage& map, const std::vector<Vector2d>& region) {
  if (region.size() < kMinCells)
    throw NotACorridor{
        "the map has no free space to measure (free cells that touch: fewer than 50)"};
  constexpr double kRoughTolerance = 0.5;  // where the corridor bends, these slices are oblique
  std::vector<Slice> slices = inliers(slices_across_axis(region), kRoughTolerance);
  double width_px = median_width(slices);
  for (int pass = 0; pass < 2; ++pass) {
    const std::vector<Vector2d> line = smoothed(slices, width_px);
    if (line.size() < kMinSlices)
      throw NotACorridor{"the free space is not a corridor: it is not longer than wide"};
    slices = inliers(slices_across_line(map, line, width_px), kWidthTolerance);
  }
  return {smoothed(slices, width_px), kSpacing * width_px, median_width(slices)};
}

}  // namespace waymark::corridor

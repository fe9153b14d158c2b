// SPDX-License-Identifier: BSD-3-Clause
#include "export/even_scan.hpp"

#include "common/geometry/angle.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::exporting {
namespace {

constexpr std::size_t kPlacesPerBeam = 4;  // places in the grid of an uneven scan, per beam
constexpr double kEven = 0.05;  // largest deviation of an even scan from a grid, in steps

/// The same directions without jumps of a turn.
std::vector<double> unwrapped(std::span<const float> angles_rad) {
  std::vector<double> result{angles_rad.front()};
  for (const double angle : angles_rad.subspan(1))
    result.push_back(result.back() + angle_difference(angle, result.back()));
  return result;
}

/// An even grid of angles.
struct AngleGrid {
  double start_rad;
  double step_rad;

  /// Place of an angle, in steps from the start.
  double place_of(double angle_rad) const {
    return step_rad > 0.0 ? (angle_rad - start_rad) / step_rad : 0.0;
  }
};

AngleGrid grid_between(double start_rad, double end_rad, std::size_t num_places) {
  const double steps = static_cast<double>(std::max<std::size_t>(num_places, 2) - 1);
  return {start_rad, (end_rad - start_rad) / steps};
}

bool is_even(const std::vector<double>& ascending_rad) {
  const AngleGrid grid =
      grid_between(ascending_rad.front(), ascending_rad.back(), ascending_rad.size());
  for (std::size_t i = 0; i < ascending_rad.size(); ++i)
    if (std::abs(grid.place_of(ascending_rad[i]) - static_cast<double>(i)) > kEven) return false;
  return true;
}

}  // namespace

EvenScan even_scan(std::span<const float> angles_rad, std::span<const float> ranges_m) {
  const std::vector<double> beams_rad = unwrapped(angles_rad);
  std::vector<double> ascending_rad = beams_rad;
  std::ranges::sort(ascending_rad);
  const std::size_t num_places =
      is_even(ascending_rad) ? beams_rad.size() : kPlacesPerBeam * beams_rad.size();
  const AngleGrid grid = grid_between(ascending_rad.front(), ascending_rad.back(), num_places);
  EvenScan scan{ascending_rad.front(), ascending_rad.back(), std::vector<float>(num_places, 0.0F)};
  std::vector<double> distances(num_places, std::numeric_limits<double>::infinity());
  for (std::size_t i = 0; i < beams_rad.size(); ++i) {
    if (!std::isfinite(ranges_m[i])) continue;
    const double place = grid.place_of(beams_rad[i]);
    const auto nearest = static_cast<std::size_t>(std::lround(place));
    const double distance = std::abs(place - static_cast<double>(nearest));
    if (distance >= distances[nearest]) continue;
    distances[nearest] = distance;
    scan.ranges_m[nearest] = ranges_m[i];
  }
  return scan;
}

}  // namespace waymark::exporting

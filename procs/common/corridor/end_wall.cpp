// SPDX-License-Identifier: BSD-3-Clause
#include "common/corridor/end_wall.hpp"

#include "common/geometry/angle.hpp"
#include "common/geometry/median.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <vector>

namespace waymark::corridor {
namespace {

constexpr double kCentralWidth = 1.0 / 3.0;  // half width of the central band [corridor widths]
constexpr double kCoverage = 0.4;            // least share of the strips that a wall covers
constexpr double kLineHalfWidth_px = 0.75;   // cells this near to a line lie on it
constexpr double kRoughness_px = 1.25;       // a wall's innermost cells are this near to its line
constexpr double kOffsetStep_px = 0.5;
constexpr int kMaxTilt_deg = 20;

/// The central strips of the corridor, -half_strips to half_strips.
struct Band {
  int half_strips{};
  std::map<int, std::vector<double>> occupied_px{};  ///< by strip: distances of its occupied cells
  std::map<int, int> free_cells{};                   ///< number of free cells by distance, rounded

  double strips() const { return 2.0 * half_strips + 1.0; }
};

Band central_band(const MapImage& map, const EndView& view, double width_px) {
  Band band{std::max(1, static_cast<int>(kCentralWidth * width_px)), {}, {}};
  for (int y = 0; y < map.height_px; ++y) {
    for (int x = 0; x < map.width_px; ++x) {
      const Cell cell = map.at(x, y);
      if (cell == Cell::kUnknown) continue;
      const Eigen::Vector2d offset = Eigen::Vector2d(x, y) - view.origin_px;
      const int strip = static_cast<int>(std::lround(offset.dot(view.across)));
      const double distance_px = offset.dot(view.outward);
      if (std::abs(strip) > band.half_strips || distance_px < view.begin_px) continue;
      if (cell == Cell::kOccupied)
        band.occupied_px[strip].push_back(distance_px);
      else
        ++band.free_cells[static_cast<int>(std::lround(distance_px))];
    }
  }
  return band;
}

/// Last distance at which at least half of the central strips are free; a gap of more than half a
/// corridor width between such distances ends the search.
int last_free_px(const Band& band, double begin_px, double width_px) {
  int last = static_cast<int>(std::lround(begin_px));
  for (const auto& [distance_px, cells] : band.free_cells) {
    if (distance_px > last + width_px / 2.0) break;
    if (cells >= band.strips() / 2.0) last = distance_px;
  }
  return last;
}

/// A straight wall: its distance in strip r is offset_px + slope * r.
struct WallLine {
  double offset_px{};
  double slope{};
  int strips{};  ///< number of strips with an occupied cell on the line

  double at(int strip) const { return offset_px + slope * strip; }
};

int strips_on(const WallLine& line, const Band& band) {
  int strips = 0;
  for (const auto& [strip, distances] : band.occupied_px) {
    strips += std::any_of(distances.begin(), distances.end(), [&, r = strip](double distance_px) {
      return std::abs(distance_px - line.at(r)) <= kLineHalfWidth_px;
    });
  }
  return strips;
}

/// The line through this offset with the most strips; of equals, the one with the smaller tilt.
WallLine best_tilt(double offset_px, const Band& band) {
  WallLine best{offset_px, 0.0, -1};
  for (int size_deg = 0; size_deg <= kMaxTilt_deg; ++size_deg) {
    for (const int tilt_deg : {size_deg, -size_deg}) {
      WallLine line{offset_px, std::tan(radians(tilt_deg)), 0};
      line.strips = strips_on(line, band);
      if (line.strips > best.strips) best = line;
    }
  }
  return best;
}

/// Innermost line that covers enough strips; then, as a tilted line may touch the wall too early,
/// the line with the most strips within `search_px` behind it.
std::optional<WallLine> innermost_wall(const Band& band, double from_px, double to_px,
                                       double search_px) {
  for (double offset_px = from_px; offset_px <= to_px; offset_px += kOffsetStep_px) {
    WallLine wall = best_tilt(offset_px, band);
    if (wall.strips < kCoverage * band.strips()) continue;
    const double last_px = offset_px + search_px;
    for (double behind_px = offset_px; behind_px <= last_px; behind_px += kOffsetStep_px) {
      const WallLine line = best_tilt(behind_px, band);
      if (line.strips > wall.strips) wall = line;
    }
    return wall;
  }
  return std::nullopt;
}

}  // namespace

CorridorEnd find_corridor_end(const MapImage& map, const EndView& view, double width_px) {
  const Band band = central_band(map, view, width_px);
  const int last_free = last_free_px(band, view.begin_px, width_px);
  CorridorEnd end{};
  end.free_extent_px = last_free + 0.5;
  const auto wall = innermost_wall(band, std::max(view.begin_px, last_free - width_px),
                                   last_free + width_px / 2.0, width_px / 8.0);
  if (!wall) return end;
  end.has_wall = true;
  std::vector<double> distances_px;
  for (const auto& [strip, occupied_px] : band.occupied_px) {
    std::optional<double> innermost_px;
    for (const double distance_px : occupied_px) {
      if (std::abs(distance_px - wall->at(strip)) <= kRoughness_px)
        innermost_px = std::min(distance_px, innermost_px.value_or(distance_px));
    }
    if (!innermost_px) continue;
    end.wall_px[strip] = *innermost_px;
    distances_px.push_back(*innermost_px);
  }
  end.median_wall_px = median(distances_px);
  return end;
}

}  // namespace waymark::corridor

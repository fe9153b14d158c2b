// SPDX-License-Identifier: BSD-3-Clause
// Corridors drawn cell by cell, with the exact length known.
#pragma once

#include "common/corridor/map_image.hpp"
#include "common/random/random.hpp"

#include <Eigen/Core>

#include <cmath>
#include <functional>
#include <optional>

namespace waymark::corridor {

/// A place in a corridor: distance along its middle from the start wall, and to the left of it.
struct InCorridor {
  double along_px{};
  double left_px{};
};

/// Where a point of the image lies in a corridor; nullopt if it is not near it.
using Shape = std::function<std::optional<InCorridor>(double x, double y)>;

/// Straight, start wall at (x0, y0), turned by an angle.
inline Shape straight_shape(double x0, double y0, double turn_rad) {
  return [=](double x, double y) -> std::optional<InCorridor> {
    const double c = std::cos(turn_rad);
    const double s = std::sin(turn_rad);
    return InCorridor{c * (x - x0) + s * (y - y0), -s * (x - x0) + c * (y - y0)};
  };
}

/// Circular arc to the left from (x0, y0), where it heads along a direction.
inline Shape arc_shape(double x0, double y0, double heading_rad, double radius_px) {
  return [=](double x, double y) -> std::optional<InCorridor> {
    const double dx = x - (x0 - radius_px * std::sin(heading_rad));
    const double dy = y - (y0 + radius_px * std::cos(heading_rad));
    const double turned = std::remainder(std::atan2(dy, dx) - heading_rad + M_PI / 2, 2 * M_PI);
    return InCorridor{turned * radius_px, radius_px - std::hypot(dx, dy)};
  };
}

/// Two arcs of equal length, first to the left, then to the right.
inline Shape s_shape(double x0, double y0, double heading_rad, double radius_px, double half_px) {
  const double turn = half_px / radius_px;
  const double x1 = x0 + radius_px * (std::sin(heading_rad + turn) - std::sin(heading_rad));
  const double y1 = y0 - radius_px * (std::cos(heading_rad + turn) - std::cos(heading_rad));
  const Shape first = arc_shape(x0, y0, heading_rad, radius_px);
  // A right-hand arc is a left-hand one seen from the other end.
  const double x2 = x1 + radius_px * (std::sin(heading_rad + turn) - std::sin(heading_rad));
  const double y2 = y1 - radius_px * (std::cos(heading_rad + turn) - std::cos(heading_rad));
  const Shape back = arc_shape(x2, y2, heading_rad + M_PI, radius_px);
  return [=](double x, double y) -> std::optional<InCorridor> {
    const auto a = first(x, y);
    if (a && a->along_px <= half_px) return a;
    const auto b = back(x, y);
    return InCorridor{2 * half_px - b->along_px, -b->left_px};
  };
}

struct Drawing {
  int width_px{};
  int height_px{};
  double length_px{};          ///< between the centres of the innermost cells of the end walls
  double half_width_px{20.0};  ///< from the middle to the centres of the side walls
  double thickness_px{1.0};    ///< thickness of the walls, which grow outwards
  bool has_start{true};
  bool has_end{true};
  double specks{0.0};  ///< probability of a false occupied cell in free space
  double holes{0.0};   ///< probability of an unknown cell in a wall
};

inline MapImage draw(const Drawing& drawing, const Shape& shape) {
  constexpr double kSlack_px = 0.5 + 1e-9;  // a cell belongs to a wall if its centre is this near
  MapImage map{drawing.width_px, drawing.height_px, 0.05, {}};
  Random random{1};
  for (int y = 0; y < map.height_px; ++y) {
    for (int x = 0; x < map.width_px; ++x) {
      Cell cell = Cell::kUnknown;
      if (const auto place = shape(x, y)) {
        const double outer_px = drawing.thickness_px - 1.0 + kSlack_px;
        const double over_start = -place->along_px;
        const double over_end = place->along_px - drawing.length_px;
        const double over_side = std::abs(place->left_px) - drawing.half_width_px;
        if (std::max({over_start, over_end, over_side}) < -kSlack_px)
          cell = random.uniform() < drawing.specks ? Cell::kOccupied : Cell::kFree;
        else if (over_start <= outer_px && over_end <= outer_px && over_side <= outer_px &&
                 (drawing.has_start || over_start < -kSlack_px) &&
                 (drawing.has_end || over_end < -kSlack_px))
          cell = random.uniform() < drawing.holes ? Cell::kUnknown : Cell::kOccupied;
      }
      map.cells.push_back(cell);
    }
  }
  return map;
}

}  // namespace waymark::corridor

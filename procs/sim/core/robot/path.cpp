// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/robot/path.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kStraightOn_rad = 1e-6;  // smaller turns are no corner
constexpr double kTurnsBack_rad = 2.8;    // larger turns stay sharp

PathPiece line(const Eigen::Vector2d& from_m, const Eigen::Vector2d& to_m) {
  const Eigen::Vector2d line_m = to_m - from_m;
  return {{from_m, std::atan2(line_m.y(), line_m.x())}, line_m.norm(), 0.0, false};
}

/// The arc between two lines that meet; of length 0 where the corner is not rounded.
PathPiece arc_between(const PathPiece& before, const PathPiece& after, double radius_m) {
  const double turn_rad =
      angle_difference(after.world_from_start.theta(), before.world_from_start.theta());
  if (radius_m <= 0.0 || std::abs(turn_rad) < kStraightOn_rad ||
      std::abs(turn_rad) > kTurnsBack_rad) {
    return {};
  }
  // An arc takes at most half of each line, so that the arcs at both ends of a line fit.
  const double per_radius = std::tan(0.5 * std::abs(turn_rad));
  const double trimmed_m =
      std::min(radius_m * per_radius, 0.5 * std::min(before.length_m, after.length_m));
  const double fitting_m = trimmed_m / per_radius;
  const Se2 world_from_start = before.world_from(before.length_m - trimmed_m);
  return {world_from_start, fitting_m * std::abs(turn_rad),
          std::copysign(1.0 / fitting_m, turn_rad), true};
}

}  // namespace

Se2 PathPiece::world_from(double along_m) const {
  if (curvature_per_m == 0.0) return world_from_start * Se2{along_m, 0.0, 0.0};
  const double turn_rad = along_m * curvature_per_m;
  return world_from_start * Se2{std::sin(turn_rad) / curvature_per_m,
                                (1.0 - std::cos(turn_rad)) / curvature_per_m, turn_rad};
}

PathPlace locate(const PathPiece& piece, const Se2& world_from_base) {
  const Se2 start_from_base = piece.world_from_start.inverse() * world_from_base;
  if (piece.curvature_per_m == 0.0)
    return {start_from_base.x(), start_from_base.y(), start_from_base.theta()};
  // A right turn is computed as a mirrored left turn.
  const double left = std::copysign(1.0, piece.curvature_per_m);
  const double radius_m = std::abs(1.0 / piece.curvature_per_m);
  const double x = start_from_base.x();
  const double to_centre = radius_m - left * start_from_base.y();
  const double turned_rad = std::atan2(x, to_centre);
  return {radius_m * turned_rad, left * (radius_m - std::hypot(x, to_centre)),
          wrap_angle(start_from_base.theta() - left * turned_rad)};
}

std::vector<PathPiece> path_through(const std::vector<Eigen::Vector2d>& points_m,
                                    double corner_radius_m) {
  std::vector<PathPiece> lines;
  for (std::size_t i = 1; i < points_m.size(); ++i)
    lines.push_back(line(points_m[i - 1], points_m[i]));

  std::vector<PathPiece> path;
  double trimmed_m = 0.0;  // length of the present line that the arc before it replaces
  for (std::size_t i = 0; i < lines.size(); ++i) {
    PathPiece piece = lines[i];
    if (trimmed_m > 0.0) piece.world_from_start = path.back().world_from(path.back().length_m);
    piece.length_m -= trimmed_m;
    trimmed_m = 0.0;
    const bool is_last = i + 1 == lines.size();
    const PathPiece arc =
        is_last ? PathPiece{} : arc_between(lines[i], lines[i + 1], corner_radius_m);
    if (arc.length_m > 0.0) {
      trimmed_m = (arc.world_from_start.translation() - points_m[i + 1]).norm();
      piece.length_m -= trimmed_m;
    }
    piece.is_smooth_end =
        arc.length_m > 0.0 ||
        (!is_last && corner_radius_m > 0.0 &&
         std::abs(angle_difference(lines[i + 1].world_from_start.theta(),
                                   lines[i].world_from_start.theta())) < kStraightOn_rad);
    path.push_back(piece);
    if (arc.length_m > 0.0) path.push_back(arc);
  }
  return path;
}

}  // namespace waymark

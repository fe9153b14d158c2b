// SPDX-License-Identifier: BSD-3-Clause
#include "common/corridor/corridor_length.hpp"

#include "common/corridor/end_wall.hpp"
#include "common/corridor/medial_line.hpp"
#include "common/geometry/median.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::corridor {
namespace {

using Eigen::Vector2d;

// A medial line is straight if all of it is nearer to its axis than this [corridor widths], ...
constexpr double kStraightDeviation = 0.1;
// ... and its arc is at most this much longer than its chord.
constexpr double kStraightExcess_px = 0.25;
constexpr double kAnchorInset = 0.5;    // from the ends of the medial line [corridor widths]
constexpr double kElongated = 2.0;      // least length over width at which the axis is reliable
constexpr double kAlongImage_px = 1.0;  // an axis along the image drifts at most this far

Vector2d left_of(const Vector2d& direction) {
  return {-direction.y(), direction.x()};
}

/// Where each end is searched for.
struct Views {
  EndView start{};
  EndView end{};
  /// Length of the medial line from start.origin_px to end.origin_px; 0 in a straight corridor.
  double between_px{};
};

/// Indices of the medial line's points from which the ends are looked for.
struct Anchors {
  std::size_t start{};
  std::size_t end{};
};

Anchors anchors_of(const MedialLine& line) {
  const auto inset = static_cast<std::size_t>(kAnchorInset * line.width_px / line.spacing_px);
  const std::size_t last = line.points_px.size() - 1;
  const std::size_t kept = std::clamp<std::size_t>(inset, 1, (last - 1) / 2);
  return {kept, last - kept};
}

double arc_length_px(const MedialLine& line, const Anchors& anchors) {
  double length_px = 0.0;
  for (std::size_t i = anchors.start; i < anchors.end; ++i)
    length_px += (line.points_px[i + 1] - line.points_px[i]).norm();
  return length_px;
}

/// The axis, turned to the nearest row or column of pixels if it drifts from that by no more than
/// kAlongImage_px: straight maps are then measured in whole pixels.
Axis along_image_if_near(Axis axis, double length_px) {
  Eigen::Index main{};
  axis.direction.cwiseAbs().maxCoeff(&main);
  if (std::abs(axis.direction[1 - main]) * length_px > kAlongImage_px) return axis;
  axis.direction = Vector2d::Unit(main);
  axis.centre_px = axis.centre_px.array().round();
  return axis;
}

bool is_straight(const MedialLine& line, const Axis& axis, const Anchors& anchors) {
  const Vector2d across = left_of(axis.direction);
  for (const Vector2d& point : line.points_px) {
    if (std::abs((point - axis.centre_px).dot(across)) > kStraightDeviation * line.width_px)
      return false;
  }
  const double chord_px = (line.points_px[anchors.end] - line.points_px[anchors.start]).norm();
  return arc_length_px(line, anchors) - chord_px <= kStraightExcess_px;
}

Views straight_views(const MedialLine& line, const Axis& axis, const Anchors& anchors) {
  const Vector2d across = left_of(axis.direction);
  const auto along = [&axis](const Vector2d& point) {
    return (point - axis.centre_px).dot(axis.direction);
  };
  return {{axis.centre_px, -axis.direction, across, -along(line.points_px[anchors.start])},
          {axis.centre_px, axis.direction, across, along(line.points_px[anchors.end])},
          0.0};
}

Views medial_views(const MedialLine& line, const Anchors& anchors) {
  const auto direction_at = [&line](std::size_t i) -> Vector2d {
    return (line.points_px[i + 1] - line.points_px[i - 1]).normalized();
  };
  const Vector2d start = direction_at(anchors.start);
  const Vector2d end = direction_at(anchors.end);
  return {{line.points_px[anchors.start], -start, left_of(start), 0.0},
          {line.points_px[anchors.end], end, left_of(end), 0.0},
          arc_length_px(line, anchors)};
}

double length_between(const CorridorEnd& start, const CorridorEnd& end) {
  const auto reach_px = [](const CorridorEnd& side) {
    return side.has_wall ? side.median_wall_px : side.free_extent_px;
  };
  std::vector<double> lengths_px;
  for (const auto& [strip, start_px] : start.wall_px) {
    const auto same_strip = end.wall_px.find(strip);
    if (same_strip != end.wall_px.end()) lengths_px.push_back(start_px + same_strip->second);
  }
  return lengths_px.empty() ? reach_px(start) + reach_px(end) : median(lengths_px);
}

}  // namespace

std::string_view name_of(LengthMethod method) {
  return method == LengthMethod::kStraight ? "straight" : "medial";
}

CorridorLength measure_corridor(const MapImage& map) {
  const MedialLine line = medial_line(map, largest_free_region(map));
  const Anchors anchors = anchors_of(line);
  const double rough_length_px = static_cast<double>(line.points_px.size()) * line.spacing_px;
  const Axis axis = along_image_if_near(principal_axis(line.points_px), rough_length_px);
  const bool straight = is_straight(line, axis, anchors);
  const Views views = straight ? straight_views(line, axis, anchors) : medial_views(line, anchors);
  const CorridorEnd start = find_corridor_end(map, views.start, line.width_px);
  const CorridorEnd end = find_corridor_end(map, views.end, line.width_px);

  CorridorLength result{};
  result.length_px = views.between_px + length_between(start, end);
  result.length_m = result.length_px * map.resolution_m;
  result.width_px = line.width_px;
  result.method = straight ? LengthMethod::kStraight : LengthMethod::kMedial;
  if (!straight) result.flags.emplace_back("curved");
  if (!start.has_wall) result.flags.emplace_back("start_wall_missing");
  if (!end.has_wall) result.flags.emplace_back("end_wall_missing");
  if (result.length_px < kElongated * line.width_px) result.flags.emplace_back("not_elongated");
  return result;
}

double accuracy_percent(double length_m, double true_length_m) {
  return 100.0 * (1.0 - std::abs(length_m - true_length_m) / true_length_m);
}

}  // namespace waymark::corridor

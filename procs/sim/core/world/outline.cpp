// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/world/outline.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

constexpr double kQuarterTurn_rad = 0.5 * std::numbers::pi;

/// A corner of a closed line: the start of the wall that runs to the next corner.
struct Corner {
  Eigen::Vector2d at_m{0.0, 0.0};
  WallKind kind{WallKind::kSide};
};

using ClosedLine = std::vector<Corner>;

double cross(const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  return a.x() * b.y() - a.y() * b.x();
}

std::vector<ClosedLine> plain_lines(const WorldConfig& world) {
  const double length = world.length_m;
  const double width = world.width_m;
  const double half = 0.5 * world.width_m;
  const double top = world.second_length_m - half;
  using enum WallKind;
  switch (world.layout) {
    case Layout::kStraight:
      return {{{{0.0, -half}, kSide},
               {{length, -half}, kEnd},
               {{length, half}, kSide},
               {{0.0, half}, kEnd}}};
    case Layout::kL:
      return {{{{0.0, -half}, kSide},
               {{length, -half}, kSide},
               {{length, top}, kEnd},
               {{length - width, top}, kSide},
               {{length - width, half}, kSide},
               {{0.0, half}, kEnd}}};
    case Layout::kRing:
      return {{{{0.0, -half}, kSide},
               {{length, -half}, kSide},
               {{length, top}, kSide},
               {{0.0, top}, kSide}},
              {{{width, half}, kSide},
               {{width, top - width}, kSide},
               {{length - width, top - width}, kSide},
               {{length - width, half}, kSide}}};
  }
  return {};
}

/// The corners of an opening in the frame of its wall (x along the wall, y into the free space), in
/// the order of the closed line; at the last corner, the wall that was cut goes on.
std::vector<Corner> opening_corners(const OpeningConfig& opening, double centre_m,
                                    double partition_m, WallKind wall_kind) {
  const double from = centre_m - 0.5 * opening.width_m;
  const double to = centre_m + 0.5 * opening.width_m;
  using enum WallKind;
  if (opening.room_width_m <= 0.0) {
    return {{{from, 0.0}, kSide},
            {{from, -opening.depth_m}, kDoor},
            {{to, -opening.depth_m}, kSide},
            {{to, 0.0}, wall_kind}};
  }
  const double room_from = centre_m - 0.5 * opening.room_width_m;
  const double room_to = centre_m + 0.5 * opening.room_width_m;
  const double back = -partition_m - opening.depth_m;
  return {
      {{from, 0.0}, kSide},        {{from, -partition_m}, kSide}, {{room_from, -partition_m}, kEnd},
      {{room_from, back}, kEnd},   {{room_to, back}, kEnd},       {{room_to, -partition_m}, kSide},
      {{to, -partition_m}, kSide}, {{to, 0.0}, wall_kind}};
}

/// Middle of an opening on the face of its wall, world frame.
Eigen::Vector2d centre_on_wall(const OpeningConfig& opening, const WorldConfig& world) {
  const Corridor corridor = corridors(world).at(static_cast<std::size_t>(opening.corridor));
  const double side = opening.side == Side::kLeft ? 1.0 : -1.0;
  return corridor.world_from_corridor *
         Eigen::Vector2d{opening.centre_m, side * 0.5 * world.width_m};
}

/// True when the point lies on the wall from -> to, more than half of width_m from both of its
/// ends.
bool has_wall(const Eigen::Vector2d& point_m, double width_m, const Corner& from,
              const Corner& to) {
  constexpr double kSlack_m = 1e-9;
  const Eigen::Vector2d along = (to.at_m - from.at_m).normalized();
  const Eigen::Vector2d offset_m = point_m - from.at_m;
  const double at_m = offset_m.dot(along);
  return std::abs(cross(along, offset_m)) < kSlack_m && at_m > 0.5 * width_m &&
         at_m < (to.at_m - from.at_m).norm() - 0.5 * width_m;
}

/// Cuts the opening into its wall and inserts the walls of the opening. False when no wall of the
/// closed line is at the opening's centre, or none is wide enough.
bool cut(ClosedLine& line, const OpeningConfig& opening, const WorldConfig& world) {
  const Eigen::Vector2d centre_m = centre_on_wall(opening, world);
  for (std::size_t i = 0; i < line.size(); ++i) {
    const Corner from = line[i];
    const Corner to = line[(i + 1) % line.size()];
    if (!has_wall(centre_m, opening.width_m, from, to)) continue;
    const Eigen::Vector2d along_m = to.at_m - from.at_m;
    const Se2 world_from_wall{from.at_m, std::atan2(along_m.y(), along_m.x())};
    const double at_m = (centre_m - from.at_m).norm();
    // Corridor and room each have a wall of their own here, back to back.
    const double partition_m = 2.0 * world.wall_thickness_m;
    std::vector<Corner> corners = opening_corners(opening, at_m, partition_m, from.kind);
    for (Corner& corner : corners)
      corner.at_m = world_from_wall * corner.at_m;
    line.insert(line.begin() + static_cast<std::ptrdiff_t>(i) + 1, corners.begin(), corners.end());
    return true;
  }
  return false;
}

void append_walls(const ClosedLine& line, const WorldConfig& world, std::vector<Wall>& walls) {
  const auto at = [&line](std::size_t i) {
    return line[i % line.size()].at_m;
  };
  // Walls are made longer only where the line turns left (seen from the free space: inner corners);
  // where it turns right, the longer wall would reach into the free space.
  const auto beyond_m = [&](std::size_t i) {
    const Eigen::Vector2d before = at(i) - at(i + line.size() - 1);
    return cross(before, at(i + 1) - at(i)) > 0.0 ? world.wall_thickness_m : 0.0;
  };
  for (std::size_t i = 0; i < line.size(); ++i) {
    walls.push_back({line[i].kind, at(i), at(i + 1), world.wall_height_m, world.wall_thickness_m,
                     beyond_m(i), beyond_m(i + 1)});
  }
}

bool cross_each_other(const Wall& a, const Wall& b) {
  const auto side = [](const Wall& wall, const Eigen::Vector2d& point_m) {
    return cross(wall.to_m - wall.from_m, point_m - wall.from_m);
  };
  return side(a, b.from_m) * side(a, b.to_m) < 0.0 && side(b, a.from_m) * side(b, a.to_m) < 0.0;
}

bool overlap(const Wall& a, const Wall& b) {
  constexpr double kSlack_m = 1e-6;
  const Eigen::Vector2d along = a.along();
  if (std::abs(cross(along, b.from_m - a.from_m)) > kSlack_m ||
      std::abs(cross(along, b.to_m - a.from_m)) > kSlack_m) {
    return false;
  }
  const auto [low, high] =
      std::minmax({along.dot(b.from_m - a.from_m), along.dot(b.to_m - a.from_m)});
  return std::min(high, a.length_m()) - std::max(low, 0.0) > kSlack_m;
}

}  // namespace

std::vector<Corridor> corridors(const WorldConfig& world) {
  const double half = 0.5 * world.width_m;
  const double length = world.length_m;
  const double second = world.second_length_m;
  std::vector<Corridor> all{{{0.0, 0.0, 0.0}, length}};
  if (world.layout == Layout::kStraight) return all;
  all.push_back({{length - half, -half, kQuarterTurn_rad}, second});
  if (world.layout == Layout::kL) return all;
  all.push_back({{length, second - world.width_m, 2.0 * kQuarterTurn_rad}, length});
  all.push_back({{half, second - half, -kQuarterTurn_rad}, second});
  return all;
}

std::vector<Wall> outline(const WorldConfig& world) {
  std::vector<Wall> walls;
  for (ClosedLine& line : plain_lines(world)) {
    for (const OpeningConfig& opening : world.openings)
      cut(line, opening, world);
    append_walls(line, world, walls);
  }
  return walls;
}

std::optional<std::size_t> opening_without_wall(const WorldConfig& world) {
  std::vector<ClosedLine> lines = plain_lines(world);
  for (std::size_t i = 0; i < world.openings.size(); ++i) {
    const OpeningConfig& opening = world.openings[i];
    if (opening.corridor >= static_cast<int>(corridors(world).size())) return i;
    if (std::none_of(lines.begin(), lines.end(),
                     [&](ClosedLine& line) { return cut(line, opening, world); })) {
      return i;
    }
  }
  return std::nullopt;
}

bool walls_cross(const std::vector<Wall>& walls) {
  for (std::size_t i = 0; i < walls.size(); ++i)
    for (std::size_t k = i + 1; k < walls.size(); ++k)
      if (cross_each_other(walls[i], walls[k]) || overlap(walls[i], walls[k])) return true;
  return false;
}

std::optional<Eigen::Vector2d> solid_in_free_space(const std::vector<Wall>& walls) {
  constexpr double kTouching_m = 1e-6;
  for (const Wall& wall : walls) {
    const Se2 world_from_wall{wall.from_m, std::atan2(wall.along().y(), wall.along().x())};
    const Se2 wall_from_world = world_from_wall.inverse();
    // Walls meet at right angles, so in these axes every face is a box without width.
    const Eigen::AlignedBox2d solid{
        Eigen::Vector2d{kTouching_m - wall.beyond_from_m, kTouching_m - wall.thickness_m},
        Eigen::Vector2d{wall.length_m() + wall.beyond_to_m - kTouching_m, -kTouching_m}};
    for (const Wall& other : walls) {
      Eigen::AlignedBox2d face;
      face.extend(wall_from_world * other.from_m).extend(wall_from_world * other.to_m);
      const Eigen::AlignedBox2d common = solid.intersection(face);
      if (!common.isEmpty()) return world_from_wall * Eigen::Vector2d{common.center()};
    }
  }
  return std::nullopt;
}

double clearance_m(const std::vector<Wall>& walls, const Eigen::Vector2d& point_m) {
  double nearest_m = std::numeric_limits<double>::infinity();
  bool is_inside = false;
  for (const Wall& wall : walls) {
    const Eigen::Vector2d offset_m = point_m - wall.from_m;
    const double share = std::clamp(offset_m.dot(wall.along()) / wall.length_m(), 0.0, 1.0);
    nearest_m = std::min(nearest_m, (offset_m - share * (wall.to_m - wall.from_m)).norm());
    // Even-odd rule with a ray along +x.
    if ((wall.from_m.y() > point_m.y()) == (wall.to_m.y() > point_m.y())) continue;
    const double rise = (point_m.y() - wall.from_m.y()) / (wall.to_m.y() - wall.from_m.y());
    if (wall.from_m.x() + rise * (wall.to_m.x() - wall.from_m.x()) > point_m.x())
      is_inside = !is_inside;
  }
  return is_inside ? nearest_m : -nearest_m;
}

}  // namespace waymark

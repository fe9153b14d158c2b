// SPDX-License-Identifier: BSD-3-Clause
#include "placement/wall_places.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <optional>
#include <set>

namespace waymark::placement {
namespace {

constexpr int kBeams = 180;
const double kSameWall = std::cos(radians(10.0));  // least cosine between the normals of a wall
constexpr double kFreeBefore_m = 0.15;             // free space needed before the wall's line

/// Whether over the width of a plate there are occupied cells within one cell of the line, and free
/// cells before the line.
bool is_bare_and_straight(const OccupiedWalls& walls, const Eigen::Vector2d& place,
                          const Eigen::Vector2d& normal, double plate_m) {
  const double cell_m = walls.image().resolution_m;
  const Eigen::Vector2d along{-normal.y(), normal.x()};
  const int reach = static_cast<int>(std::ceil(0.5 * plate_m / cell_m));
  for (int i = -reach; i <= reach; ++i) {
    const Eigen::Vector2d point = place + i * cell_m * along;
    bool has_wall = false;
    for (const double off : {-1.0, 0.0, 1.0})
      has_wall = has_wall || walls.state_at(point + off * cell_m * normal) == Cell::kOccupied;
    const Cell before = walls.state_at(point + (kFreeBefore_m + cell_m) * normal);
    if (!has_wall || before != Cell::kFree) return false;
  }
  return true;
}

std::string side_of(const Eigen::Vector2d& place_in_base) {
  const double bearing_rad = std::atan2(place_in_base.y(), place_in_base.x());
  if (std::abs(bearing_rad) < 0.25 * std::numbers::pi) return "ahead";
  if (std::abs(bearing_rad) > 0.75 * std::numbers::pi) return "behind";
  return bearing_rad > 0.0 ? "left" : "right";
}

const Step& nearest_step(std::span<const Step> steps, const Eigen::Vector2d& place) {
  return *std::min_element(steps.begin(), steps.end(), [&](const Step& a, const Step& b) {
    return (a.map_from_base.translation() - place).squaredNorm() <
           (b.map_from_base.translation() - place).squaredNorm();
  });
}

std::optional<Se2> place_at(const OccupiedWalls& walls, std::size_t cell,
                            const Eigen::Vector2d& seen_from, double plate_m) {
  const WallPatch& patch = walls.patch(cell);
  if (!patch.is_line) return std::nullopt;
  Eigen::Vector2d normal = patch.normal;
  if (normal.dot(seen_from - patch.point) < 0.0) normal = -normal;
  const Eigen::Vector2d centre = walls.centre_of(cell);
  const Eigen::Vector2d place = centre - normal.dot(centre - patch.point) * normal;
  if (!is_bare_and_straight(walls, place, normal, plate_m)) return std::nullopt;
  return Se2{place, std::atan2(normal.y(), normal.x())};
}

}  // namespace

bool overlap(const Se2& a, const Se2& b, double plate_m) {
  return (a.translation() - b.translation()).norm() < plate_m &&
         a.rotation().col(0).dot(b.rotation().col(0)) > kSameWall;
}

std::vector<WallPlace> free_wall_places(std::span<const Step> steps, const OccupiedWalls& walls,
                                        std::span<const Se2> hung, double plate_m, double range_m,
                                        double spacing_m) {
  std::vector<WallPlace> places;
  std::set<std::size_t> looked_at;
  for (const Step& step : steps) {
    const Eigen::Vector2d from = step.map_from_base.translation();
    for (int beam = 0; beam < kBeams; ++beam) {
      const double angle_rad = step.map_from_base.theta() + 2.0 * std::numbers::pi * beam / kBeams;
      const auto cell = walls.first_hit(from, {std::cos(angle_rad), std::sin(angle_rad)}, range_m);
      if (!cell || !looked_at.insert(*cell).second) continue;
      const auto place = place_at(walls, *cell, from, plate_m);
      if (!place) continue;
      const auto is_taken = [&](const Se2& other, double apart_m) {
        return overlap(*place, other, apart_m);
      };
      if (std::any_of(hung.begin(), hung.end(),
                      [&](const Se2& marker) { return is_taken(marker, plate_m); }) ||
          std::any_of(places.begin(), places.end(), [&](const WallPlace& other) {
            return is_taken(other.map_from_marker, spacing_m);
          })) {
        continue;
      }
      const Step& passing = nearest_step(steps, place->translation());
      places.push_back({*place, passing.travel_m,
                        side_of(passing.map_from_base.inverse() * place->translation())});
    }
  }
  std::stable_sort(places.begin(), places.end(),
                   [](const WallPlace& a, const WallPlace& b) { return a.travel_m < b.travel_m; });
  return places;
}

}  // namespace waymark::placement

// SPDX-License-Identifier: BSD-3-Clause
#include "batch_limit/association.hpp"

#include <Eigen/Cholesky>

#include <cmath>
#include <optional>

namespace waymark::benchmark {
namespace {

constexpr double kSameWall_m = 0.1;
constexpr double kSameWall_rad = radians(4.0);
constexpr double kHangsOff_m = 0.1;  // a marker further from a wall does not hang on it
constexpr double kHangsSkew_rad = radians(15.0);

/// The wall through a place, with about that normal.
std::optional<std::size_t> wall_at(const Eigen::Vector2d& place, double normal_rad, double within_m,
                                   double within_rad, const std::vector<Wall>& walls) {
  std::optional<std::size_t> nearest;
  double nearest_m = within_m;
  for (std::size_t i = 0; i < walls.size(); ++i) {
    const Wall& wall = walls[i];
    const double away_m = std::abs(wall.normal().dot(place - wall.anchor));
    if (std::abs(angle_difference(normal_rad, wall.normal_rad)) > within_rad) continue;
    if (away_m > nearest_m) continue;
    nearest = i;
    nearest_m = away_m;
  }
  return nearest;
}

std::optional<std::size_t> wall_of(const LineOfScan& line, const Se2& map_from_base,
                                   const std::vector<Wall>& walls) {
  return wall_at(map_from_base * line.middle, map_from_base.theta() + line.normal_rad, kSameWall_m,
                 kSameWall_rad, walls);
}

/// Gauss-Newton step for (x, y, theta) in the map, from what the known walls say.
Eigen::Vector3d step_to_walls(const Stop& stop, const std::vector<std::optional<std::size_t>>& seen,
                              const Se2& map_from_base, const std::vector<Wall>& walls,
                              const Eigen::Matrix3d& prior_in_map) {
  Eigen::Matrix3d information = prior_in_map.inverse();
  Eigen::Vector3d pull = Eigen::Vector3d::Zero();
  for (std::size_t i = 0; i < stop.lines.size(); ++i) {
    if (!seen[i]) continue;
    const LineOfScan& line = stop.lines[i];
    const Wall& wall = walls[*seen[i]];
    const Eigen::Vector2d arm = map_from_base.rotation() * line.middle;
    const Eigen::Vector2d normal = wall.normal();
    const Eigen::Vector3d by_offset{normal.x(), normal.y(),
                                    normal.dot(Eigen::Vector2d{-arm.y(), arm.x()})};
    const double off_m = normal.dot(map_from_base.translation() + arm - wall.anchor);
    const double off_rad =
        angle_difference(map_from_base.theta() + line.normal_rad, wall.normal_rad);
    const double offset_weight = 1.0 / (line.sigma_m * line.sigma_m);
    const double turn_weight = 1.0 / (line.sigma_rad * line.sigma_rad);
    information += offset_weight * by_offset * by_offset.transpose();
    information(2, 2) += turn_weight;
    pull -= offset_weight * off_m * by_offset;
    pull.z() -= turn_weight * off_rad;
  }
  return information.ldlt().solve(pull);
}

Se2 next_pose(const Stop& stop, const Se2& map_from_last, const OdometryNoise& noise,
              const std::vector<Wall>& walls) {
  const CorrectedMotion motion = corrected_motion(stop.motion, OdometryErrors::Zero(), noise);
  const Se2 map_from_base = map_from_last * motion.start_from_end;
  std::vector<std::optional<std::size_t>> seen;
  for (const LineOfScan& line : stop.lines)
    seen.push_back(wall_of(line, map_from_base, walls));
  return moved_by(map_from_base,
                  step_to_walls(stop, seen, map_from_base, walls,
                                in_axes(map_from_last.rotation(), motion.covariance)));
}

void link_walls(const Stop& stop, std::size_t index, Scene& scene) {
  const Se2& map_from_base = scene.map_from_base.back();
  for (std::size_t i = 0; i < stop.lines.size(); ++i) {
    const LineOfScan& line = stop.lines[i];
    auto wall = wall_of(line, map_from_base, scene.walls);
    if (!wall) {
      wall = scene.walls.size();
      scene.walls.push_back(
          {map_from_base * line.middle, wrap_angle(map_from_base.theta() + line.normal_rad), {}});
    }
    scene.wall_links.push_back({index, i, *wall});
  }
}

void link_markers(const Stop& stop, std::size_t index, double same_within_m, Scene& scene) {
  const Se2& map_from_base = scene.map_from_base.back();
  for (std::size_t i = 0; i < stop.markers.size(); ++i) {
    const Se2 map_from_marker = map_from_base * stop.markers[i].base_from_marker;
    std::size_t marker = scene.markers.size();
    double nearest_m = same_within_m;
    for (std::size_t m = 0; m < scene.markers.size(); ++m) {
      if (scene.markers[m].id != stop.markers[i].id) continue;
      const double away_m =
          (scene.markers[m].map_from_marker.translation() - map_from_marker.translation()).norm();
      if (away_m < nearest_m) {
        nearest_m = away_m;
        marker = m;
      }
    }
    if (marker == scene.markers.size())
      scene.markers.push_back({stop.markers[i].id, map_from_marker, std::nullopt});
    scene.marker_links.push_back({index, i, marker});
  }
}

}  // namespace

Scene associate(std::span<const Stop> stops, const OdometryNoise& noise,
                double same_marker_within_m) {
  Scene scene;
  for (std::size_t i = 0; i < stops.size(); ++i) {
    scene.map_from_base.push_back(
        i == 0 ? Se2{} : next_pose(stops[i], scene.map_from_base.back(), noise, scene.walls));
    link_walls(stops[i], i, scene);
    link_markers(stops[i], i, same_marker_within_m, scene);
  }
  for (Marker& marker : scene.markers)
    marker.wall = wall_at(marker.map_from_marker.translation(), marker.map_from_marker.theta(),
                          kHangsOff_m, kHangsSkew_rad, scene.walls);
  return scene;
}

}  // namespace waymark::benchmark

// SPDX-License-Identifier: BSD-3-Clause
#include "placement/drive.hpp"

#include "common/geometry/squared.hpp"
#include "slam/core/registration/points_in_map.hpp"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

namespace waymark::placement {
namespace {

constexpr double kStep_m = 0.25;
constexpr double kStep_rad = 0.3;
// Mean of cos^2 of the angle of incidence over the beams that hit one spot of a wall during a drive
// past it (uniform in -90 to 90 degrees). These beams determine the spread of the map's points
// there, whatever the incidence of the current beam.
constexpr double kMeanFacing2 = 0.5;

/// Sets each step's weak axis: the direction that the walls do not observe. Where they observe all,
/// the last weak axis stays, as the uncertainty along it persists.
void carry_weak_axes(std::vector<Step>& steps) {
  Eigen::Vector2d last = Eigen::Vector2d::Zero();
  for (Step& step : steps) {
    if (step.observed.is_degenerate)
      last = step.map_from_base.rotation() * step.observed.weak_direction;
    step.weak_axis = last;
  }
}

}  // namespace

ObservedAxes predict_scan(const OccupiedWalls& walls, const Se2& map_from_base,
                          const SlamConfig& config, std::vector<Eigen::Vector2d>& hits) {
  const LidarConfig& lidar = config.robot.lidar;
  const ScanMatchConfig& scan = config.slam.waymark.scan;
  const Se2 map_from_lidar = map_from_base * lidar.base_from_lidar();
  const Eigen::Matrix2d base_from_map = map_from_base.rotation().transpose();

  struct Beam {
    Eigen::Vector3d jacobian_pose{};
    double across_m2{0.0};
    NdtMap::Key cell{0};
  };

  std::vector<Beam> beams;
  std::map<NdtMap::Key, int> beams_on;
  const NdtMap ndt{scan.cell_spacing_m};
  hits.clear();
  for (int beam = 0; beam < lidar.num_beams; ++beam) {
    const double angle_rad =
        map_from_lidar.theta() + 2.0 * std::numbers::pi * beam / lidar.num_beams;
    const Eigen::Vector2d direction{std::cos(angle_rad), std::sin(angle_rad)};
    const auto cell = walls.first_hit(map_from_lidar.translation(), direction, lidar.range_max_m);
    if (!cell) continue;
    const WallPatch& patch = walls.patch(*cell);
    const double facing = std::abs(patch.normal.dot(direction));
    Eigen::Vector2d end = walls.centre_of(*cell);
    if (patch.is_line && facing > 0.0) {
      end -= patch.normal.dot(end - patch.point) * patch.normal;
    }
    const Eigen::Vector2d in_base = base_from_map * (end - map_from_base.translation());
    if ((end - map_from_lidar.translation()).norm() < lidar.range_min_m) continue;
    hits.push_back(in_base);
    if (!patch.is_line) continue;
    const Eigen::Vector2d normal = base_from_map * patch.normal;
    const Eigen::Vector3d jacobian_pose{normal.x(), normal.y(),
                                        in_base.x() * normal.y() - in_base.y() * normal.x()};
    const double across_m2 =
        squared(lidar.range_sigma_m) * std::max(kMeanFacing2, squared(facing)) +
        squared(scan.roughness_m);
    const NdtMap::Key ndt_cell = ndt.key_at(end);
    beams.push_back({jacobian_pose, across_m2, ndt_cell});
    ++beams_on[ndt_cell];
  }
  Eigen::Matrix3d information = Eigen::Matrix3d::Zero();
  for (const Beam& beam : beams) {
    information += independent_share(beams_on[beam.cell]) / beam.across_m2 * beam.jacobian_pose *
                   beam.jacobian_pose.transpose();
  }
  ObservedAxes observed = observed_axes(information, scan.weak_share);
  if (static_cast<int>(hits.size()) < scan.min_inliers) {
    observed.information.setZero();
    observed.is_degenerate = true;
  }
  return observed;
}

std::vector<Step> drive_along(std::span<const ScanPlace> places, const OccupiedWalls& walls,
                              const SlamConfig& config) {
  std::vector<Step> steps;
  Motion motion;
  double travel_m = 0.0;
  std::size_t begin = 0;
  const auto add_step = [&](std::size_t scan) {
    Step step;
    step.scan = scan;
    step.map_from_base = places[scan].map_from_base;
    step.travel_m = travel_m;
    step.motion = motion;
    const double spent_s = places[scan].t_s - places[begin].t_s;
    if (spent_s > 0.0) {
      step.scans = static_cast<double>(scan - begin);
      step.speed_mps = motion.distance_m / spent_s;
    }
    step.observed = predict_scan(walls, step.map_from_base, config, step.hits);
    steps.push_back(std::move(step));
    motion = {};
    begin = scan;
  };
  add_step(0);
  for (std::size_t i = 1; i < places.size(); ++i) {
    const Motion moved = Motion::between(places[i - 1].map_from_base, places[i].map_from_base);
    motion = motion.then(moved);
    travel_m += moved.distance_m;
    const bool is_last = i + 1 == places.size();
    if (motion.distance_m >= kStep_m || std::abs(motion.start_from_end.theta()) >= kStep_rad ||
        (is_last && motion.distance_m > 0.0)) {
      add_step(i);
    }
  }
  carry_weak_axes(steps);
  return steps;
}

}  // namespace waymark::placement

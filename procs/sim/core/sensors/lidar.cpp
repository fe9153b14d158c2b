// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/sensors/lidar.hpp"

#include "common/random/random.hpp"
#include "sim/core/random_streams.hpp"
#include "sim/core/world/mjcf.hpp"

#include <array>
#include <cmath>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

constexpr double kNoReturn = std::numeric_limits<double>::infinity();
constexpr double kInvalid = std::numeric_limits<double>::quiet_NaN();

}  // namespace

void LidarNoiseConfig::describe(Fields& fields) {
  fields.field("range_sigma_m", range_sigma_m, kNotNegative, "standard deviation of a range");
  fields.field("dropout_probability", dropout_probability, kFraction,
               "chance of a beam to be invalid");
}

double wall_distance_m(const Physics& physics, const Eigen::Vector3d& from_m,
                       const Eigen::Vector3d& direction) {
  constexpr mjtByte kWithStaticGeoms = 1;
  constexpr int kNoExcludedBody = -1;
  std::array<mjtByte, mjNGROUP> groups{};
  groups[static_cast<std::size_t>(GeomGroup::kWalls)] = 1;
  int geom = -1;
  const double distance_m =
      mj_ray(&physics.model(), &physics.data(), from_m.data(), direction.data(), groups.data(),
             kWithStaticGeoms, kNoExcludedBody, &geom);
  return geom < 0 ? kNoReturn : distance_m;
}

Lidar::Lidar(const LidarConfig& config, const LidarNoiseConfig& noise, std::int64_t seed)
    : config_{config}, noise_{noise}, seed_{static_cast<std::uint64_t>(seed)} {}

LidarScan Lidar::scan(Timestamp time, const Physics& physics) {
  LidarScan scan;
  scan.time = time;
  add_beams(scan, config_.num_beams, physics);
  return scan;
}

void Lidar::add_beams(LidarScan& scan, int count, const Physics& physics) {
  const Eigen::Isometry3d world_from_base = physics.world_from_base_3d();
  const Eigen::Vector3d lidar_in_base{config_.x_m, config_.y_m, config_.z_m};
  const Eigen::Vector3d lidar_in_world = world_from_base * lidar_in_base;
  const double step_rad = 2.0 * std::numbers::pi / config_.num_beams;
  for (int i = 0; i < count; ++i) {
    const double angle_rad = static_cast<double>(scan.ranges_m.size()) * step_rad;
    const double in_base_rad = config_.yaw_rad + (config_.mirrored ? -angle_rad : angle_rad);
    const Eigen::Vector3d direction =
        world_from_base.linear() *
        Eigen::Vector3d{std::cos(in_base_rad), std::sin(in_base_rad), 0.0};
    scan.angles_rad.push_back(angle_rad);
    scan.ranges_m.push_back(measured_m(wall_distance_m(physics, lidar_in_world, direction)));
  }
}

double Lidar::measured_m(double true_range_m) {
  Random random{seed_, random_streams::kLidar, beam_++};
  if (random.uniform() < noise_.dropout_probability) return kInvalid;
  const double range_m = true_range_m + noise_.range_sigma_m * random.normal();
  if (range_m > config_.range_max_m) return kNoReturn;
  return range_m < config_.range_min_m ? kInvalid : range_m;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/mounting.hpp"

#include "common/geometry/median.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <functional>
#include <optional>

namespace waymark {
namespace {

constexpr double kSame_m = 0.02;
constexpr double kSame_rad = 0.02;
constexpr double kEqual_m = 1e-3;
constexpr double kEqual_rad = 1e-3;
constexpr double kNearlyAll = 0.95;  // share of the lines that have to agree
constexpr std::string_view kRemedy = "--lidar-x-m, --lidar-y-m, --lidar-yaw-deg say otherwise";

bool is_same(const Se2& a, const Se2& b, double within_m, double within_rad) {
  return (a.translation() - b.translation()).norm() < within_m &&
         std::abs(angle_difference(a.theta(), b.theta())) < within_rad;
}

double median_of(std::span<const Se2> poses, const std::function<double(const Se2&)>& value_of) {
  std::vector<double> values;
  for (const Se2& pose : poses)
    values.push_back(value_of(pose));
  return upper_median(std::move(values));
}

/// The pose that nearly all lines have; nullopt if they differ, as in logs with corrected LiDAR
/// poses.
std::optional<Se2> common_pose(std::span<const Se2> poses) {
  const double some_rad = poses[poses.size() / 2].theta();
  const Se2 middle{median_of(poses, [](const Se2& pose) { return pose.x(); }),
                   median_of(poses, [](const Se2& pose) { return pose.y(); }),
                   some_rad + median_of(poses, [&](const Se2& pose) {
                     return angle_difference(pose.theta(), some_rad);
                   })};
  const auto num_same = std::ranges::count_if(
      poses, [&](const Se2& pose) { return is_same(pose, middle, kSame_m, kSame_rad); });
  const bool is_constant =
      static_cast<double>(num_same) >= kNearlyAll * static_cast<double>(poses.size());
  return is_constant ? std::optional{middle} : std::nullopt;
}

std::optional<Se2> of_parameters(const std::vector<CarmenMounting>& parameters, CarmenLidar lidar) {
  Eigen::Vector3d values = Eigen::Vector3d::Zero();
  bool any = false;
  for (const CarmenMounting& parameter : parameters) {
    if (parameter.lidar != lidar) continue;
    values(static_cast<Eigen::Index>(parameter.what)) = parameter.value;
    any = true;
  }
  return any ? std::optional{Se2{values(0), values(1), values(2)}} : std::nullopt;
}

std::string text_of(const Se2& pose) {
  return fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.2f} deg", pose.x(), pose.y(),
                     degrees(pose.theta()));
}

}  // namespace

Se2 find_mounting(std::span<const Se2> base_from_lidar,
                  const std::vector<CarmenMounting>& parameters, CarmenLidar lidar,
                  ImportReport& report) {
  const auto from_poses = common_pose(base_from_lidar);
  const auto from_parameters = of_parameters(parameters, lidar);
  const bool poses_are_equal = from_poses && is_same(*from_poses, Se2{}, kEqual_m, kEqual_rad);
  if (from_poses && !poses_are_equal) {
    if (from_parameters && !is_same(*from_poses, *from_parameters, kSame_m, kSame_rad)) {
      report.note(fmt::format(
          "LiDAR mounting: the LiDAR's lines say {}, the PARAM lines {}: the former is taken; {}",
          text_of(*from_poses), text_of(*from_parameters), kRemedy));
    }
    return *from_poses;
  }
  if (from_parameters) {
    report.note(fmt::format("LiDAR mounting taken from the PARAM lines: {}; {}",
                            text_of(*from_parameters), kRemedy));
    return *from_parameters;
  }
  report.note(fmt::format(
      "the log does not say where the LiDAR sits (its pose and that of odometry {}): the base's "
      "origin is taken; {}",
      from_poses ? "are equal" : "differ by a changing amount, as in a corrected log", kRemedy));
  return {};
}

}  // namespace waymark

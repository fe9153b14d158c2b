// SPDX-License-Identifier: BSD-3-Clause
#include "slam/last_pose.hpp"

#include "common/config/config.hpp"
#include "common/files/whole_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <system_error>

namespace waymark {
namespace {

constexpr Duration kLongPause = std::chrono::minutes{10};
constexpr Duration kRestart = std::chrono::seconds{30};  // the robot is not carried in less
constexpr double kStands_m = 0.1;
constexpr double kStands_rad = 0.1;
constexpr double kFastest_m_s = 2.0;  // mean speed of our robots, at most
constexpr double kFastest_rad_s = 2.0;
constexpr double kNotSaid_m = 0.02;  // motion between the last write and the stop
constexpr double kNotSaid_rad = 0.02;
constexpr double kOdometryError = 0.05;  // share of the distance
constexpr double kOdometryError_rad_per_m = 0.05;

struct LastPoseFields {
  std::vector<std::string> map_ids{};
  std::int64_t utime{0};
  double x_m{0.0};
  double y_m{0.0};
  double yaw_rad{0.0};
  double sigma_x_m{1.0};
  double sigma_y_m{1.0};
  double sigma_yaw_rad{1.0};
  double odometry_x_m{0.0};
  double odometry_y_m{0.0};
  double odometry_yaw_rad{0.0};

  void describe(Fields& fields) {
    fields.field("map_ids", map_ids,
                 "of the map files in whose frame the pose is, as waymark-map prints them");
    fields.field("utime", utime, {0.0, 9e15}, "message time [us]");
    fields.field("x_m", x_m, kAnyNumber, "base in the map");
    fields.field("y_m", y_m, kAnyNumber, "base in the map");
    fields.field("yaw_rad", yaw_rad, kAnyNumber, "base in the map");
    fields.field("sigma_x_m", sigma_x_m, kNotNegative, "standard deviation of x_m");
    fields.field("sigma_y_m", sigma_y_m, kNotNegative, "standard deviation of y_m");
    fields.field("sigma_yaw_rad", sigma_yaw_rad, kNotNegative, "standard deviation of yaw_rad");
    fields.field("odometry_x_m", odometry_x_m, kAnyNumber, "ODOMETRY at that time");
    fields.field("odometry_y_m", odometry_y_m, kAnyNumber, "ODOMETRY at that time");
    fields.field("odometry_yaw_rad", odometry_yaw_rad, kAnyNumber, "ODOMETRY at that time");
  }
};

}  // namespace

bool is_in_map(const LastPose& pose, std::int64_t map_id) {
  return std::ranges::find(pose.map_ids, map_id) != pose.map_ids.end();
}

std::filesystem::path last_pose_file(const std::filesystem::path& state_folder) {
  return state_folder / "last_pose.toml";
}

void write_last_pose(const std::filesystem::path& state_folder, const LastPose& pose) {
  LastPoseFields fields;
  for (const std::int64_t map_id : pose.map_ids)
    fields.map_ids.push_back(fmt::format("{:016x}", static_cast<std::uint64_t>(map_id)));
  fields.utime = to_us(pose.time);
  fields.x_m = pose.map_from_base.x();
  fields.y_m = pose.map_from_base.y();
  fields.yaw_rad = pose.map_from_base.theta();
  fields.sigma_x_m = pose.sigmas.x();
  fields.sigma_y_m = pose.sigmas.y();
  fields.sigma_yaw_rad = pose.sigmas.z();
  fields.odometry_x_m = pose.odom_from_base.x();
  fields.odometry_y_m = pose.odom_from_base.y();
  fields.odometry_yaw_rad = pose.odom_from_base.theta();
  write_whole_file(last_pose_file(state_folder), dump_config(fields));
}

std::optional<LastPose> read_last_pose(const std::filesystem::path& state_folder) {
  const std::filesystem::path file = last_pose_file(state_folder);
  std::error_code ignored;  // of a file that cannot be examined: load_config() says what is wrong
  if (std::filesystem::status(file, ignored).type() == std::filesystem::file_type::not_found)
    return std::nullopt;
  ConfigSources sources;
  sources.files = {file};
  const auto fields = load_config<LastPoseFields>(sources);
  LastPose pose;
  for (const std::string& map_id : fields.map_ids)
    pose.map_ids.push_back(static_cast<std::int64_t>(std::strtoull(map_id.c_str(), nullptr, 16)));
  pose.time = timestamp_from_us(fields.utime);
  pose.map_from_base = {fields.x_m, fields.y_m, fields.yaw_rad};
  pose.sigmas = {fields.sigma_x_m, fields.sigma_y_m, fields.sigma_yaw_rad};
  pose.odom_from_base = {fields.odometry_x_m, fields.odometry_y_m, fields.odometry_yaw_rad};
  return pose;
}

Resumption resume(const LastPose& last, std::int64_t map_id, Timestamp now,
                  const Se2& odom_from_base) {
  if (!is_in_map(last, map_id)) return {std::nullopt, "it is in another map"};
  if (now < last.time) return {std::nullopt, "it is newer than the sensors' messages"};
  const Se2 driven = last.odom_from_base.inverse() * odom_from_base;
  const double distance_m = driven.translation().norm();
  const double turn_rad = std::abs(driven.theta());
  const double pause_s = to_seconds(now - last.time);
  const bool has_stood = distance_m <= kStands_m && turn_rad <= kStands_rad;
  if (!has_stood && now - last.time > kLongPause)
    return {std::nullopt, "odometry has changed in a pause of more than ten minutes"};
  if (!has_stood && (distance_m > kFastest_m_s * pause_s + kNotSaid_m ||
                     turn_rad > kFastest_rad_s * pause_s + kNotSaid_rad)) {
    return {std::nullopt, "odometry does not continue from there"};
  }
  const Se2 map_from_base = last.map_from_base * driven;
  StartPose start{StartKind::kLast, map_from_base.x(), map_from_base.y(), map_from_base.theta()};
  start.sigma_m =
      std::hypot(last.sigmas.head<2>().maxCoeff(), kNotSaid_m + kOdometryError * distance_m);
  start.sigma_rad =
      std::hypot(last.sigmas.z(), kNotSaid_rad + kOdometryError_rad_per_m * distance_m);
  start.is_certain = now - last.time <= kRestart;
  return {start, ""};
}

}  // namespace waymark

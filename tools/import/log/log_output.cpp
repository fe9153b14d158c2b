// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/log_output.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "common/robot/robot_config.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <utility>
#include <vector>

namespace waymark {
namespace {

/// @throws SetupError when the file exists with other contents: it may belong to another log, or
/// have been edited by hand.
void check_not_replaced(const std::filesystem::path& path, const std::string& text) {
  if (!std::filesystem::exists(path) || read_whole_file(path) == text) return;
  throw SetupError{path.string() +
                   ": is there already, with another content; give --out in another folder, or "
                   "move it away"};
}

/// @throws SetupError
void check_is_new(const std::filesystem::path& log) {
  if (!std::filesystem::is_regular_file(log)) return;  // LogWriter refuses anything else
  throw SetupError{log.string() +
                   ": is there already; an import replaces no log: give --out another name, or "
                   "move it away"};
}

std::string to_tum(const std::vector<ImportedPose>& poses) {
  std::string text;
  for (const ImportedPose& pose : poses) {
    const std::int64_t us = to_us(pose.time);
    text += fmt::format("{}.{:06} {:.6f} {:.6f} 0 0 0 {:.9f} {:.9f}\n", us / 1'000'000,
                        us % 1'000'000, pose.pose.x(), pose.pose.y(),
                        std::sin(0.5 * pose.pose.theta()), std::cos(0.5 * pose.pose.theta()));
  }
  return text;
}

void write_log(const ImportedLog& log, const std::filesystem::path& out) {
  std::vector<Message> messages;
  for (const ImportedScan& scan : log.scans)
    messages.push_back(scan.message);
  for (const ImportedPose& sample : log.odometry) {
    messages.push_back(encode(channels::kOdometry, to_pose_message(sample.time, sample.pose)));
  }
  for (const ImportedImage& image : log.images)
    messages.push_back(image.message);
  std::ranges::sort(messages, comes_before);
  LogWriter writer{out};
  for (const Message& message : messages)
    writer.write(message);
  writer.close();
}

/// Reads the text as slam does.
/// @throws SetupError with the first problem.
void check_robot(const std::string& toml) {
  try {
    load_config<RobotOnly>({.texts = {{"robot.toml", toml}}});
  } catch (const ConfigError& error) {
    const std::string problems = error.what();
    throw SetupError{"slam would refuse the robot's description: " +
                     problems.substr(0, problems.find('\n'))};
  }
}

double longest_range_m(const ImportedLog& log) {
  return std::ranges::max(log.scans, {}, &ImportedScan::longest_range_m).longest_range_m;
}

std::string beam_counts(const ImportedLog& log) {
  const auto [fewest, most] = std::ranges::minmax(log.scans, {}, &ImportedScan::num_beams);
  return fewest.num_beams == most.num_beams
             ? fmt::format("{}", most.num_beams)
             : fmt::format("{}..{}", fewest.num_beams, most.num_beams);
}

/// The notes of the import as comments, so that readers of the file know which values are
/// estimates.
std::string findings_of(const ImportReport& report) {
  std::string text;
  for (const std::string& note : report.notes())
    text += "# import: " + note + "\n";
  return text;
}

std::string skipped(const ImportReport& report) {
  std::string text = fmt::format("{}", report.num_skipped());
  for (const auto& [kind, count] : report.skipped_by_kind())
    text += fmt::format(", {} {}", kind, count);
  return text;
}

}  // namespace

void write_imported_log(const ImportedLog& log, const ImportReport& report,
                        const std::filesystem::path& out) {
  const std::string robot = dump_robot_config(log.robot);
  const std::filesystem::path folder = out.has_parent_path() ? out.parent_path() : ".";
  std::vector<std::pair<std::filesystem::path, std::string>> beside{
      {folder / "robot.toml", findings_of(report) + robot}};
  if (!log.reference.empty()) beside.emplace_back(folder / "reference.tum", to_tum(log.reference));
  try {
    check_robot(robot);
    check_is_new(out);
    for (const auto& [path, text] : beside)
      check_not_replaced(path, text);
    std::filesystem::create_directories(folder);
    write_log(log, out);
    for (const auto& [path, text] : beside)
      write_whole_file(path, text);
  } catch (const std::runtime_error& error) {
    throw SetupError{error.what()};
  }
}

std::string summary(const ImportedLog& log, const ImportReport& report) {
  const auto [first, last] = std::ranges::minmax(log.odometry, {}, &ImportedPose::time);
  const LidarConfig& lidar = log.robot.lidar;
  std::string text;
  const auto line = [&text](std::string_view name, const std::string& value) {
    text += fmt::format("{:<17}{}\n", name, value);
  };
  line("read", log.contents);
  line("scans", fmt::format("{}", log.scans.size()));
  line("beams", beam_counts(log));
  line("odometry", fmt::format("{} samples", log.odometry.size()));
  if (!log.images.empty()) line("images", fmt::format("{}", log.images.size()));
  line("duration", fmt::format("{:.3f} s", to_seconds(last.time - first.time)));
  line("path length", fmt::format("{:.3f} m (odometry)", path_length_m(log.odometry)));
  if (!log.reference.empty()) {
    line("reference", fmt::format("{} poses, path length {:.3f} m", log.reference.size(),
                                  path_length_m(log.reference)));
  }
  line("longest range", fmt::format("{:.3f} m", longest_range_m(log)));
  line("range maximum", fmt::format("{:.3f} m (no return from there on)", lidar.range_max_m));
  line("range noise", fmt::format("{:.4f} m", lidar.range_sigma_m));
  line("LiDAR mounting", fmt::format("x {:.3f} m, y {:.3f} m, yaw {:.2f} deg", lidar.x_m, lidar.y_m,
                                     degrees(lidar.yaw_rad)));
  line("skipped", skipped(report));
  return text;
}

}  // namespace waymark

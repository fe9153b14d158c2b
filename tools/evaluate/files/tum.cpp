// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/files/tum.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <string>

namespace waymark::evaluate {
namespace {

constexpr double kTimeRounding_s = 1.5e-6;

/// Heading of the x axis [rad]; nullopt if the quaternion's length is not nearly 1.
std::optional<double> yaw_of(double qx, double qy, double qz, double qw) {
  constexpr double kLengthTolerance = 1e-2;
  const double norm = std::sqrt(qx * qx + qy * qy + qz * qz + qw * qw);
  if (std::abs(norm - 1.0) > kLengthTolerance) return std::nullopt;
  return std::atan2(2.0 * (qw * qz + qx * qy), qw * qw + qx * qx - qy * qy - qz * qz);
}

}  // namespace

Trajectory read_tum(const std::filesystem::path& file, SkippedLines& skipped) {
  const std::vector<std::string> lines = read_lines(file);
  Trajectory trajectory;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].front() == '#') continue;
    const auto skip = [&](std::string_view reason) {
      skipped.push_back(at_line(file, i + 1, reason));
    };
    const auto numbers = parse_numbers(lines[i]);
    if (!numbers || numbers->size() != 8) {
      skip(fmt::format("got '{}', expected 8 finite numbers t x y z qx qy qz qw", lines[i]));
      continue;
    }
    const auto& n = *numbers;
    const auto yaw_rad = yaw_of(n[4], n[5], n[6], n[7]);
    if (!yaw_rad)
      skip("the quaternion qx qy qz qw is not of unit length");
    else if (!trajectory.empty() && n[0] <= trajectory.back().t_s)
      skip(fmt::format("time {:.6f} does not advance", n[0]));
    else
      trajectory.push_back({n[0], Se2{n[1], n[2], *yaw_rad}});
  }
  if (trajectory.empty())
    throw SetupError{file.string() + ": no pose in it; expected lines t x y z qx qy qz qw"};
  return trajectory;
}

std::optional<Se2> pose_at(const Trajectory& trajectory, double t_s) {
  if (t_s < trajectory.front().t_s - kTimeRounding_s ||
      t_s > trajectory.back().t_s + kTimeRounding_s)
    return std::nullopt;
  const auto after =
      std::lower_bound(trajectory.begin(), trajectory.end(), t_s,
                       [](const StampedPose& pose, double time_s) { return pose.t_s < time_s; });
  if (after == trajectory.begin()) return trajectory.front().parent_from_base;
  if (after == trajectory.end()) return trajectory.back().parent_from_base;
  const StampedPose& before = *std::prev(after);
  return interpolate(before.parent_from_base, after->parent_from_base,
                     (t_s - before.t_s) / (after->t_s - before.t_s));
}

}  // namespace waymark::evaluate

// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/wheel_odometry.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr double kFastest_m_s = 10.0;

struct WheelStep {
  double left_m{0.0};
  double right_m{0.0};

  double longest_m() const { return std::max(std::abs(left_m), std::abs(right_m)); }
};

/// Increase of the count, also across the counter's wrap-around.
std::int32_t gained(std::int32_t now, std::int32_t before) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(now) -
                                   static_cast<std::uint32_t>(before));
}

Se2 motion(const WheelStep& step, double wheel_base_m) {
  const double distance_m = 0.5 * (step.left_m + step.right_m);
  const double turn_rad = (step.right_m - step.left_m) / wheel_base_m;
  return {distance_m * std::cos(0.5 * turn_rad), distance_m * std::sin(0.5 * turn_rad), turn_rad};
}

}  // namespace

WheelGeometry geometry_of(RobotModel model) {
  constexpr double kWheelBase_m = 0.08;
  if (model == RobotModel::kMaebot2014) return {std::numbers::pi * 0.032 / 480.0, kWheelBase_m};
  return {0.100528 / 1200.0, kWheelBase_m};
}

std::vector<ImportedPose> wheel_odometry(std::span<const EncoderTicks> ticks,
                                         const WheelGeometry& geometry, ImportReport& report) {
  std::vector<ImportedPose> poses;
  for (std::size_t i = 0; i < ticks.size(); ++i) {
    Se2 odom_from_base{};
    if (i > 0) {
      const WheelStep step{geometry.meters_per_tick * gained(ticks[i].left, ticks[i - 1].left),
                           geometry.meters_per_tick * gained(ticks[i].right, ticks[i - 1].right)};
      const double seconds = to_seconds(ticks[i].time - ticks[i - 1].time);
      odom_from_base = poses.back().pose;
      if (step.longest_m() <= kFastest_m_s * seconds) {
        odom_from_base = odom_from_base * motion(step, geometry.wheel_base_m);
      } else {
        report.skip(
            "wheel jump", ticks[i].at,
            fmt::format("{:.3f} m in {:.6f} s; the step is left out", step.longest_m(), seconds));
      }
    }
    poses.push_back({ticks[i].time, ticks[i].at, odom_from_base});
  }
  return poses;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// An imported log of a robot that drives to and fro in a room.
#pragma once

#include "common/messages/codec.hpp"
#include "import/log/imported_log.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <random>
#include <vector>

namespace waymark {

enum class CountedAs { kDriven, kForward };
enum class Walls { kRoom, kCorridor };

/// Motions between scans [m, rad]: 20 steps ahead, 20 back, 20 ahead; slow where it turns back.
inline std::vector<Se2> to_and_fro(double turn_rad = 0.01) {
  std::vector<Se2> steps;
  for (int i = 0; i < 60; ++i) {
    const double length_m = i % 20 == 0 || i % 20 == 19 ? 0.02 : 0.05;
    steps.emplace_back(i / 20 == 1 ? -length_m : length_m, 0.0, turn_rad);
  }
  return steps;
}

inline double range_to_walls_m(const Se2& pose, double angle_rad, Walls walls) {
  const double heading_rad = pose.theta() + angle_rad;
  const double c = std::cos(heading_rad);
  const double s = std::sin(heading_rad);
  const double to_x_m = (c > 0.0 ? 4.0 - pose.x() : -3.0 - pose.x()) / c;
  const double to_y_m = (s > 0.0 ? 2.0 - pose.y() : -2.5 - pose.y()) / s;
  return walls == Walls::kCorridor ? to_y_m : std::min(to_x_m, to_y_m);
}

/// 181 beams with 1 cm noise, five scans a second.
inline ImportedLog drive(const std::vector<Se2>& steps, CountedAs counted,
                         Walls walls = Walls::kRoom) {
  constexpr double kLongest_m = 20.0;
  std::mt19937 random{11};
  std::normal_distribution<double> noise{0.0, 0.01};
  ImportedLog log{};
  log.robot.lidar.x_m = 0.0;
  Se2 true_pose{};
  Se2 odometry{};
  for (std::size_t i = 0; i <= steps.size(); ++i) {
    if (i > 0) {
      const Se2& step = steps[i - 1];
      true_pose = true_pose * step;
      odometry = odometry * (counted == CountedAs::kForward && step.x() < 0.0
                                 ? Se2{-step.translation(), step.theta()}
                                 : step);
    }
    const Timestamp time = timestamp_from_us(1'000'000 + 200'000 * static_cast<std::int64_t>(i));
    planar_lidar_t message{};
    message.utime = to_us(time);
    message.nranges = 181;
    message.rad0 = static_cast<float>(-0.5 * std::numbers::pi);
    message.radstep = static_cast<float>(radians(1.0));
    for (int beam = 0; beam < message.nranges; ++beam) {
      const double range_m =
          range_to_walls_m(true_pose, radians(beam - 90.0), walls) + noise(random);
      message.ranges.push_back(range_m > 0.0 && range_m < kLongest_m
                                   ? static_cast<float>(range_m)
                                   : std::numeric_limits<float>::infinity());
    }
    log.scans.push_back(
        {time, time, 0, message.nranges, 0.0, encode(channels::kLidar, message), {}});
    log.odometry.push_back({time, 0, odometry});
  }
  return log;
}

/// Replaces each range [m] by change(range, index of the beam).
template <class Change>
void edit_ranges(ImportedLog& log, const Change& change) {
  for (ImportedScan& scan : log.scans) {
    auto message = decode<planar_lidar_t>(scan.message.payload).message.value();
    for (std::size_t beam = 0; beam < message.ranges.size(); ++beam)
      message.ranges[beam] = change(message.ranges[beam], beam);
    scan.message = encode(channels::kLidar, message);
  }
}

}  // namespace waymark

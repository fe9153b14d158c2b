// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/ros_scan.hpp"

#include "common/messages/codec.hpp"
#include "common/messages/validate.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace waymark {
namespace {

constexpr std::size_t kMaxBeams = 4000;   // limit of robot.lidar.num_beams
constexpr double kLongestSweep_s = 10.0;  // limit for a lidar_t
constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

float range_of(float range_m, const RosScan& scan) {
  if (std::isnan(range_m) || range_m <= 0.0F) return kNotMeasured;
  if (scan.range_max_m > 0.0F && range_m >= scan.range_max_m) return kNoReturn;
  return range_m < scan.range_min_m ? kNotMeasured : range_m;
}

planar_lidar_t planar_message(const RosScan& scan, Timestamp time, float sense) {
  planar_lidar_t message{};
  message.utime = to_us(time);
  message.rad0 = sense * scan.angle_min_rad;
  message.radstep = sense * scan.angle_increment_rad;
  return message;
}

lidar_t rotating_message(const RosScan& scan, Timestamp time, float sense) {
  lidar_t message{};
  message.utime = to_us(time);
  message.intensities.assign(scan.ranges_m.size(), 0.0F);
  for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
    const float angle_rad = scan.angle_min_rad + static_cast<float>(i) * scan.angle_increment_rad;
    message.thetas.push_back(-sense * angle_rad);  // clockwise
    const double offset_s = static_cast<double>(i) * double{scan.time_increment_s};
    message.times.push_back(to_us(time + duration_from_seconds(offset_s)));
  }
  return message;
}

LineProblem absurd(RejectReason reason) {
  return {"absurd scan", std::string{to_string(reason)}};
}

}  // namespace

RosScanResult to_imported_scan(const RosScan& scan, Timestamp time, std::int64_t at,
                               LidarOrientation orientation) {
  const std::size_t num_beams = scan.ranges_m.size();
  const double sweep_s = std::abs(double{scan.time_increment_s}) * static_cast<double>(num_beams);
  if (num_beams == 0) return LineProblem{"absurd scan", "no beam"};
  if (num_beams > kMaxBeams) {
    return LineProblem{"too many beams",
                       fmt::format("{}, at most {} are read", num_beams, kMaxBeams)};
  }
  if (sweep_s > kLongestSweep_s)
    return LineProblem{"absurd scan", fmt::format("its beams take {:g} s", sweep_s)};
  std::vector<float> ranges_m;
  ImportedScan imported{.time = time, .last_beam_time = time, .at = at};
  imported.num_beams = static_cast<int>(num_beams);
  for (const float range_m : scan.ranges_m) {
    ranges_m.push_back(range_of(range_m, scan));
    if (!std::isfinite(ranges_m.back())) continue;
    imported.longest_range_m = std::max(imported.longest_range_m, double{ranges_m.back()});
  }
  const float sense = orientation == LidarOrientation::kUpright ? 1.0F : -1.0F;
  if (scan.time_increment_s == 0.0F) {
    planar_lidar_t message = planar_message(scan, time, sense);
    message.nranges = imported.num_beams;
    message.ranges = std::move(ranges_m);
    const RejectReason reason = validate(message);
    if (reason != RejectReason::kNone) return absurd(reason);
    imported.message = encode(channels::kLidar, message);
  } else {
    lidar_t message = rotating_message(scan, time, sense);
    message.num_ranges = imported.num_beams;
    message.ranges = std::move(ranges_m);
    imported.last_beam_time = timestamp_from_us(std::ranges::max(message.times));
    const RejectReason reason = validate(message);
    if (reason != RejectReason::kNone) return absurd(reason);
    imported.message = encode(channels::kMbotLidar, message);
  }
  return imported;
}

}  // namespace waymark

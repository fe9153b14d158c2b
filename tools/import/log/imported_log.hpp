// SPDX-License-Identifier: BSD-3-Clause
// What is read from a foreign log, before it is written in our form.
#pragma once

#include "common/messages/message.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "import/log/import_report.hpp"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

struct ImportedScan {
  Timestamp time{};
  Timestamp last_beam_time{};
  std::int64_t at{0};  ///< where it stands in the file, see ImportReport
  int num_beams{0};
  double longest_range_m{0.0};          ///< of the ranges that are returns
  Message message{};                    ///< for the channel LIDAR
  std::optional<Se2> odom_from_base{};  ///< when the scan itself carries odometry
  bool is_mirrored{false};              ///< the message's angles count clockwise
  Duration late{0};                     ///< of the message's stamp; `time` has none
};

struct ImportedPose {
  Timestamp time{};
  std::int64_t at{0};
  Se2 pose{};
};

struct ImportedImage {
  Timestamp time{};
  std::int64_t at{0};
  Message message{};  ///< for the channel CAMERA
};

struct ImportedLog {
  std::vector<ImportedScan> scans{};     ///< ascending times
  std::vector<ImportedPose> odometry{};  ///< odom_from_base, ascending times
  std::vector<ImportedPose>
      reference{};  ///< poses of the base that the log itself gives, ascending
  std::vector<ImportedImage> images{};
  RobotConfig robot{};
  std::vector<double> no_return_codes_m{};  ///< ranges that were found to say so, ascending
  std::string contents{};                   ///< what the file held, for the summary
};

/// Where the user says how the LiDAR is mounted; nullopt = as the log says, else at the origin.
struct LidarMounting {
  std::optional<double> x_m{};
  std::optional<double> y_m{};
  std::optional<double> yaw_rad{};
};

/// The scan of the message, as slam will see it.
LidarScan scan_of(const ImportedScan& scan);

/// Mirrors the scan back and takes `late` off its times, on top of what was done before.
void put_right(ImportedScan& scan, bool is_mirrored, Duration late);

/// The pose at a time, interpolated; before the first and after the last one these.
/// @param poses  not empty, ascending times
Se2 pose_at(const std::vector<ImportedPose>& poses, Timestamp time);

/// Odometry's motion from one scan to another, by index.
Se2 odometry_between(const ImportedLog& log, std::size_t first, std::size_t last);

/// Removes scans whose number of beams is rare: garbled lines. Counts of at least two scans that
/// differ by one beam from the usual one (of equals: the smallest number), or that a twentieth of
/// all scans have, are a driver's habit (180 and 181) and are kept, which is said.
void keep_usual_beam_count(std::vector<ImportedScan>& scans, ImportReport& report);

/// A scan is processed when odometry has reached it. Where odometry starts after the first scan or
/// ends before the last one by at most a second, its first or last pose is held, or the motion of
/// the second beside it carried on; scans and images further out are removed.
void cover_scans(ImportedLog& log, ImportReport& report);

/// Puts everything in order, takes the odometry from the scans where there is no other, and fills
/// in the robot's rates and beams.
/// @throws SetupError when no scan or no odometry is left.
void complete(ImportedLog& log, ImportReport& report);

/// Multiplies the distances of odometry.
void scale_distances(std::vector<ImportedPose>& odometry, double factor);

/// Length of a path [m].
double path_length_m(const std::vector<ImportedPose>& poses);

}  // namespace waymark

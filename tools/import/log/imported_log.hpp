// SPDX-License-Identifier: BSD-3-Clause
// The contents of another robot's log, before they are written as an LCM log.
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
  std::int64_t at{0};  ///< position in the file, see ImportReport
  int num_beams{0};
  double longest_range_m{0.0};          ///< no-returns excluded
  Message message{};                    ///< for the channel LIDAR
  std::optional<Se2> odom_from_base{};  ///< odometry pose in the scan's record, if it has one
  bool is_mirrored{false};              ///< the message's angles count clockwise
  Duration late{0};                     ///< delay of the message's stamp; subtracted in `time`
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
  /// Reference poses of the base that the log itself has, ascending times.
  std::vector<ImportedPose> reference{};
  std::vector<ImportedImage> images{};
  RobotConfig robot{};
  std::vector<double> no_return_codes_m{};  ///< ranges found to mean "no return", ascending
  std::string contents{};                   ///< channels or topics with counts, for the summary
  /// What was added to the stamps of odometry and images, whose clocks are not the LiDAR's.
  Duration odometry_shift{0};
  Duration images_shift{0};
};

/// Pose of the LiDAR in the base frame as given by the user; nullopt = from the log, else 0.
struct LidarMounting {
  std::optional<double> x_m{};
  std::optional<double> y_m{};
  std::optional<double> yaw_rad{};
};

/// The message decoded as slam decodes it.
LidarScan scan_of(const ImportedScan& scan);

/// Mirrors the scan if `is_mirrored`, and subtracts `late` from its times; corrections add up.
void correct(ImportedScan& scan, bool is_mirrored, Duration late);

/// The pose at a time, interpolated; held before the first and after the last one.
/// @param poses  not empty, ascending times
Se2 pose_at(const std::vector<ImportedPose>& poses, Timestamp time);

/// Motion between two scans (indices) by odometry: first_from_last.
Se2 odometry_between(const ImportedLog& log, std::size_t first, std::size_t last);

/// Removes scans with a rare number of beams (garbled lines). The most frequent number is kept (the
/// smallest, if several are) and, with a note, numbers that at least two scans have and that differ
/// from it by one, or that 5 % of all scans have: some drivers alternate (180, 181 beams).
void keep_usual_beam_count(std::vector<ImportedScan>& scans, ImportReport& report);

/// Extends odometry to cover the scans, as slam processes no scan without odometry. Where odometry
/// starts after the first scan or ends before the last one by at most a second, the motion of the
/// adjacent second is extrapolated; with too few samples there, the first or last pose is held.
/// Scans and images more than a second outside odometry's times are removed.
void cover_scans(ImportedLog& log, ImportReport& report);

/// Makes the log usable for slam: sorts slightly disordered records by time, removes records that
/// are still out of order, takes odometry from the scans if there is no other, applies
/// cover_scans(), and sets the rates and the number of beams in `log.robot`.
/// @throws SetupError when no scan or no odometry is left; where their stamps lie apart, with how
/// far.
void make_consistent(ImportedLog& log, ImportReport& report);

/// Multiplies x and y of all poses by `factor`.
void scale_distances(std::vector<ImportedPose>& odometry, double factor);

/// Length of a path [m].
double path_length_m(const std::vector<ImportedPose>& poses);

}  // namespace waymark

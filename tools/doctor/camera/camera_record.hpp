// SPDX-License-Identifier: BSD-3-Clause
// Markers, blur and dictionaries in the camera frames of a log.
#pragma once

#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "doctor/motion/lidar_motion.hpp"

#include <opencv2/core.hpp>

#include <cstdint>
#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace waymark {

/// A marker in one frame, with the described camera and marker size.
struct CameraSighting {
  int id{kNoMarker};
  Timestamp time{};
  Eigen::Vector3d place_in_camera{Eigen::Vector3d::Zero()};  ///< centre, optical frame
  Eigen::Matrix3d covariance_in_camera{Eigen::Matrix3d::Identity()};
  double facing_rad{0.0};  ///< direction that the marker faces, base frame
};

struct CameraRecord {
  bool has_images{true};           ///< false: only sightings, from MARKERS
  std::vector<Timestamp> times{};  ///< of all frames
  /// Frames that were to be decoded; without images, messages of MARKERS that were read.
  std::int64_t num_examined{0};
  std::map<std::string, std::int64_t> problems{};  ///< number of unusable frames by reason
  std::vector<CameraSighting> sightings{};
  /// Of sightings whose blur could be measured: its standard deviation (MeasuredCorners::blur_px).
  std::vector<double> blurs_px{};
  std::vector<double> modules_px{};  ///< side of a module, for the same sightings as blurs_px
  /// Numbers of markers read in some of the frames: with the described dictionary, and with the
  /// largest one of every family.
  std::int64_t markers_of_described{0};
  std::map<std::string, std::int64_t> markers_by_dictionary{};
  std::map<std::string, int> largest_id{};  ///< by dictionary
};

/// Sightings from MARKERS, for a log without images: up to 1200 messages, evenly spread.
/// @param robot  the description with which the detector ran.
CameraRecord read_markers(const std::filesystem::path& lcm_log, const RobotConfig& robot);

/// Decodes up to 400 frames of CAMERA, evenly spread.
CameraRecord read_camera(const std::filesystem::path& lcm_log, const RobotConfig& robot,
                         const ShowProgress& progress = {});

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// A log with what is known of its robot.
#pragma once

#include "doctor/camera/camera_record.hpp"
#include "import/log/imported_log.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

struct ChannelTraffic {
  std::int64_t messages{0};
  std::int64_t bytes{0};
  std::int64_t largest_bytes{0};
};

/// Where log.robot.lidar's place comes from.
enum class Mounting { kUnknown, kInLog, kDescribed };

struct DoctorInput {
  ImportedLog log{};
  ImportReport report;
  bool noise_is_estimated{false};  ///< log.robot.lidar.range_sigma_m is of this log
  Mounting mounting{Mounting::kUnknown};
  std::optional<RobotConfig> described{};            ///< robot.toml
  std::map<std::string, ChannelTraffic> channels{};  ///< of an LCM log
  std::optional<CameraRecord> camera{};  ///< of an LCM log with CAMERA and a description
};

/// Which channels of an LCM log to read; empty = the only one of its kind.
struct InputChannels {
  std::string lidar{};
  std::string odometry{};
  std::string encoders{};
};

/// An LCM log, a bag of ROS, or a CARMEN log (text, gzip, bzip2), whatever its name.
/// What a description says of mirrored scans and late stamps is put right.
/// @param robot  robot.toml, later files win; empty = the one beside the log, if there is one
/// @throws SetupError when the log cannot be used
DoctorInput read_input(const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& robot,
                       const InputChannels& channels, const ShowProgress& progress = {});

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// A log and the description of its robot.
#pragma once

#include "doctor/camera/camera_record.hpp"
#include "import/log/imported_log.hpp"

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

/// Times without a record of one sensor while others were recorded [s].
struct Silence {
  double at_start_s{0.0};
  double at_end_s{0.0};
};

struct ChannelTraffic {
  std::int64_t messages{0};
  std::int64_t bytes{0};
  std::int64_t largest_bytes{0};
  double first_s{0.0};  ///< time of the first message since the start of the log
  double last_s{0.0};   ///< time of the last message since the start of the log
};

/// Origin of the LiDAR's mounting in log.robot.lidar.
enum class Mounting { kUnknown, kInLog, kDescribed };

struct DoctorInput {
  ImportedLog log{};
  ImportReport report;
  bool noise_is_estimated{false};  ///< log.robot.lidar.range_sigma_m was estimated from this log
  Mounting mounting{Mounting::kUnknown};
  std::optional<RobotConfig> described{};            ///< robot.toml
  std::map<std::string, ChannelTraffic> channels{};  ///< of an LCM log
  double recorded_s{0.0};       ///< duration of an LCM log, without steps of the recorder's clock
  std::string lidar_channel{};  ///< of an LCM log
  std::string odometry_channel{};  ///< of an LCM log; empty: the only channel with wheel ticks
  std::optional<CameraRecord> camera{};  ///< of an LCM log with CAMERA or MARKERS, if described
};

/// How long the channel is silent at both ends of the log; zero if it is not in the log.
Silence silence_of(const DoctorInput& input, const std::string& channel);

/// Names of the channels to read from an LCM log. Empty: `lidar` is the only channel with scans;
/// odometry is ODOMETRY or, if that is missing, comes from the only channel with encoder ticks.
struct InputChannels {
  std::string lidar{};
  std::string odometry{};
  std::string encoders{};
};

/// Reads an LCM log, a ROS bag, or a CARMEN log (text, gzip, bzip2); the format is recognised by
/// its content. Corrects mirrored scans and late stamps as described in robot.toml.
/// @param robot  robot.toml, later files win; empty = the one beside the log, if there is one.
/// @throws SetupError when the log cannot be used.
DoctorInput read_input(const std::filesystem::path& file,
                       const std::vector<std::filesystem::path>& robot,
                       const InputChannels& channels, const ShowProgress& progress = {});

}  // namespace waymark

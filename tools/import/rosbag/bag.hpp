// SPDX-License-Identifier: BSD-3-Clause
// Bags of ROS: what is in them, whatever the file's format.
#pragma once

#include "common/time/time.hpp"
#include "import/log/import_report.hpp"
#include "import/rosbag/byte_cursor.hpp"

#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

namespace waymark {

/// How the bytes of a message are laid out.
enum class RosEncoding { kRos1, kCdr };

/// A message as it stands in a bag; its bytes live as long as the call that hands it out.
struct RosRecord {
  const std::string& topic;
  const std::string& type;  ///< "sensor_msgs/LaserScan", of ROS 2 too
  RosEncoding encoding;
  Timestamp recorded;
  std::int64_t at;  ///< byte offset in the file (of the chunk, where it is compressed); .db3: row
  ByteView data;
};

using TakeRecord = std::function<void(const RosRecord&)>;

/// By its first bytes; false for what cannot be read.
bool is_bag(const std::filesystem::path& file);

/// Hands out every message in the order of the file: .bag (ROS 1, version 2.0), .db3 and .mcap (ROS
/// 2), told apart by their first bytes. What is damaged is reported as skipped.
/// @throws SetupError when the file cannot be read, or is no bag.
void read_bag(const std::filesystem::path& file, const TakeRecord& take, ImportReport& report);

void read_ros1_bag(const std::filesystem::path& file, const TakeRecord& take, ImportReport& report);
void read_db3_bag(const std::filesystem::path& file, const TakeRecord& take, ImportReport& report);
void read_mcap_bag(const std::filesystem::path& file, const TakeRecord& take, ImportReport& report);

/// Names are ASCII in ROS: other bytes, which damage puts there, become '?'.
std::string ros_name(std::string_view bytes);

/// "sensor_msgs/msg/LaserScan" -> "sensor_msgs/LaserScan".
std::string ros_type_name(std::string type);

/// Nanoseconds of a bag as our time; nothing before 1970 and after 2099.
std::optional<Timestamp> time_from_ns(std::int64_t ns);

}  // namespace waymark

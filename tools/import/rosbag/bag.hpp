// SPDX-License-Identifier: BSD-3-Clause
// Reads the messages of ROS bags, in any of the file formats.
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

/// Serialisation of a message.
enum class RosEncoding { kRos1, kCdr };

/// A serialised message of a bag. References and bytes are valid during the callback only.
struct RosRecord {
  const std::string& topic;
  const std::string& type;  ///< "sensor_msgs/LaserScan", for ROS 2 as well
  RosEncoding encoding;
  Timestamp recorded;
  std::int64_t at;  ///< byte offset in the file (of the chunk, where it is compressed); .db3: row
  ByteView data;
};

using HandleRecord = std::function<void(const RosRecord&)>;

/// Whether the file starts like a bag; false if it cannot be read.
bool is_bag(const std::filesystem::path& file);

/// Calls `handle` for every message in file order. Formats: .bag (ROS 1, version 2.0), .db3 and
/// .mcap (ROS 2), recognised by their first bytes. Damaged records are reported as skipped.
/// @throws SetupError when the file cannot be read, or is no bag.
void read_bag(const std::filesystem::path& file, const HandleRecord& handle, ImportReport& report);

void read_ros1_bag(const std::filesystem::path& file, const HandleRecord& handle,
                   ImportReport& report);
void read_db3_bag(const std::filesystem::path& file, const HandleRecord& handle,
                  ImportReport& report);
void read_mcap_bag(const std::filesystem::path& file, const HandleRecord& handle,
                   ImportReport& report);

/// Replaces bytes that are not printable ASCII by '?': ROS names have none, damaged ones may.
std::string ros_name(std::string_view bytes);

/// "sensor_msgs/msg/LaserScan" -> "sensor_msgs/LaserScan".
std::string ros_type_name(std::string type);

/// Nanoseconds since 1970 as a timestamp; nothing before 1970 or after 2099.
std::optional<Timestamp> time_from_ns(std::int64_t ns);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Bags of rosbag2 (.db3) with a few messages, written field by field.
#pragma once

#include "import_files.hpp"

#include <sqlite3.h>

#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <vector>

namespace waymark {

inline constexpr std::int64_t kBagStart_ns = 1'600'000'000'000'000'000;

/// Writes the fields of a message in CDR.
class CdrWriter {
 public:
  template <class Number>
  CdrWriter& put(Number value) {
    bytes_.resize((bytes_.size() + sizeof(Number) - 1) / sizeof(Number) * sizeof(Number));
    const auto at = bytes_.size();
    bytes_.resize(at + sizeof(Number));
    std::memcpy(bytes_.data() + at, &value, sizeof(Number));
    return *this;
  }

  CdrWriter& text(const std::string& text) {
    put(static_cast<std::uint32_t>(text.size() + 1));
    bytes_ += text + '\0';
    return *this;
  }

  template <class Number>
  CdrWriter& all(const std::vector<Number>& values) {
    for (const Number value : values)
      put(value);
    return *this;
  }

  template <class Number>
  CdrWriter& list(const std::vector<Number>& values) {
    return put(static_cast<std::uint32_t>(values.size())).all(values);
  }

  CdrWriter& header(std::int64_t time_ns, const std::string& frame) {
    return put(static_cast<std::uint32_t>(time_ns / 1'000'000'000))
        .put(static_cast<std::uint32_t>(time_ns % 1'000'000'000))
        .text(frame);
  }

  std::string done() const { return std::string{'\0', '\1', '\0', '\0'} + bytes_; }

 private:
  std::string bytes_{};
};

struct BagMessage {
  std::string topic{};
  std::string type{};
  std::int64_t time_ns{0};
  std::string data{};
};

inline BagMessage bag_scan(int i, std::size_t num_beams = 6) {
  const std::int64_t time_ns = kBagStart_ns + 100'000'000 * std::int64_t{i};
  CdrWriter data;
  data.header(time_ns, "laser").all<float>({-1.0F, 1.5F, 0.5F, 0.0F, 0.1F, 0.1F, 10.0F});
  data.list(std::vector<float>(num_beams, 2.0F)).list<float>({});
  return {"/scan", "sensor_msgs/msg/LaserScan", time_ns, data.done()};
}

inline BagMessage bag_odometry(int i) {
  const std::int64_t time_ns = kBagStart_ns + 100'000'000 * std::int64_t{i};
  CdrWriter data;
  data.header(time_ns, "odom").text("base").all<double>({0.02 * i, 0, 0, 0, 0, 0, 1});
  return {"/odom", "nav_msgs/msg/Odometry", time_ns, data.all(std::vector(78, 0.0)).done()};
}

inline BagMessage bag_image(const std::string& topic, const std::string& encoding, int width_px,
                            int height_px, int pixel_bytes) {
  CdrWriter data;
  data.header(kBagStart_ns, "camera").all<std::int32_t>({height_px, width_px}).text(encoding);
  data.put(std::uint8_t{0}).put(width_px * pixel_bytes);
  const auto size = static_cast<std::size_t>(width_px * height_px * pixel_bytes);
  data.list(std::vector<std::uint8_t>(size, 100));
  return {topic, "sensor_msgs/msg/Image", kBagStart_ns, data.done()};
}

/// A CameraInfo with the given P (fx, cx, fy, cy), and a K with the focal length k.
inline BagMessage bag_camera_info(int width_px, int height_px, const std::vector<double>& p,
                                  double k = 55.0) {
  CdrWriter data;
  data.header(kBagStart_ns, "camera").all<std::int32_t>({height_px, width_px}).text("plumb_bob");
  data.list<double>({0.1, -0.2, 0, 0, 0}).all<double>({k, 0, 31, 0, k, 23, 0, 0, 1});
  data.all(std::vector(9, 0.0)).all<double>({p[0], 0, p[1], 0, 0, p[2], p[3], 0, 0, 0, 1, 0});
  return {"/camera_info", "sensor_msgs/msg/CameraInfo", kBagStart_ns, data.done()};
}

/// tf_static with the LiDAR 0.25 m ahead of the base, and an arm with that quaternion.
inline BagMessage bag_transforms(const std::vector<double>& arm_xyzw) {
  CdrWriter data;
  data.put(std::uint32_t{2});
  data.header(0, "base").text("arm").all<double>({0, 0, 0}).all(arm_xyzw);
  data.header(0, "base").text("laser").all<double>({0.25, 0, 0.1, 0, 0, 0, 1});
  return {"/tf_static", "tf2_msgs/msg/TFMessage", kBagStart_ns, data.done()};
}

inline std::filesystem::path write_bag(const std::vector<BagMessage>& messages) {
  const auto file = test_folder() / "bag.db3";
  std::filesystem::remove(file);
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open(file.c_str(), &database), SQLITE_OK);
  const auto run = [&](const std::string& command, const std::string& data = "") {
    sqlite3_stmt* statement = nullptr;
    EXPECT_EQ(sqlite3_prepare_v2(database, command.c_str(), -1, &statement, nullptr), SQLITE_OK);
    const auto size = static_cast<int>(data.size());
    sqlite3_bind_blob(statement, 1, data.data(), size, SQLITE_TRANSIENT);
    EXPECT_EQ(sqlite3_step(statement), SQLITE_DONE) << sqlite3_errmsg(database);
    sqlite3_finalize(statement);
  };
  run("BEGIN");
  run("CREATE TABLE topics(id INTEGER PRIMARY KEY, name, type, serialization_format)");
  run("CREATE TABLE messages(id INTEGER PRIMARY KEY, topic_id, timestamp, data)");
  std::map<std::string, std::string> ids;
  for (const BagMessage& message : messages) {
    const auto [id, is_new] = ids.try_emplace(message.topic, std::to_string(ids.size() + 1));
    if (is_new)
      run("INSERT INTO topics VALUES(" + id->second + ",'" + message.topic + "','" + message.type +
          "','cdr')");
    run("INSERT INTO messages(topic_id, timestamp, data) VALUES(" + id->second + "," +
            std::to_string(message.time_ns) + ",?)",
        message.data);
  }
  run("COMMIT");
  sqlite3_close(database);
  return file;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// The slam process without a network, on a short drive.
#pragma once

#include "common/messages/convert.hpp"
#include "slam/slam_node.hpp"
#include "support/synthetic_corridor.hpp"

#include <algorithm>
#include <map>
#include <string>
#include <vector>

namespace waymark {

inline SlamConfig small_config() {
  SlamConfig config;
  config.slam.marker_matching.particles = 20;
  return config;
}

/// What was measured between two times, as messages in the order of a recorded log.
inline std::vector<Message> messages_of(const test::SensorLog& log, double from_s = 0.0,
                                        double to_s = 1e6) {
  std::vector<Message> messages;
  for (const LidarScan& scan : log.scans)
    messages.push_back(encode(channels::kLidar, to_planar_lidar(scan)));
  for (const OdometrySample& sample : log.odometry) {
    messages.push_back(
        encode(channels::kOdometry, to_pose_message(sample.time, sample.odom_from_base)));
  }
  for (const MarkerDetections& frame : log.frames)
    messages.push_back(encode(channels::kMarkers, to_detections_message(frame)));
  std::erase_if(messages, [&](const Message& message) {
    const double time_s = 1e-6 * static_cast<double>(to_us(message.time));
    return time_s < from_s || time_s > to_s;
  });
  std::sort(messages.begin(), messages.end(), comes_before);
  return messages;
}

/// A short drive.
inline std::vector<Message> messages_of_drive(double drive_m = 0.6) {
  test::SyntheticCorridor corridor;
  corridor.length_m = 8.0;
  corridor.drive_m = drive_m;
  corridor.markers = test::opposite_markers(corridor);
  return messages_of(test::drive(corridor));
}

struct Slam {
  Inbox inbox{};
  Outbox outbox{};
  SlamNode node;

  explicit Slam(const SlamConfig& config = small_config()) : node{config, inbox, outbox} {}

  std::vector<Message> feed(const std::vector<Message>& messages) {
    for (const Message& message : messages)
      inbox.deliver(message);
    node.finish();
    return outbox.take();
  }
};

inline std::map<std::string, int> count_by_channel(const std::vector<Message>& messages) {
  std::map<std::string, int> counts;
  for (const Message& message : messages)
    ++counts[message.channel];
  return counts;
}

}  // namespace waymark

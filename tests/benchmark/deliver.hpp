// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "slam/core/input/sensor_queue.hpp"

namespace waymark::benchmark {

/// One message of a log, as slam takes it: LIDAR, ODOMETRY or MARKERS.
inline void deliver(const Message& message, SensorQueue& queue) {
  if (message.channel == channels::kLidar.name) {
    if (const auto planar = decode<planar_lidar_t>(message.payload).message)
      queue.add(to_scan(*planar));
    else if (const auto rolling = decode<lidar_t>(message.payload).message)
      queue.add(to_scan(*rolling));
  } else if (message.channel == channels::kOdometry.name) {
    if (const auto pose = decode<pose2D_t>(message.payload).message) queue.add(to_odometry(*pose));
  } else if (const auto frame = decode<marker_detections_t>(message.payload).message) {
    queue.add(to_detections(*frame));
  }
}

}  // namespace waymark::benchmark

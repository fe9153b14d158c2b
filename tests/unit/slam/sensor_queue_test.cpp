// SPDX-License-Identifier: BSD-3-Clause
// Unit tests of what the queue lets through.
#include "slam/core/input/sensor_queue.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

Timestamp at_ms(int milliseconds) {
  return Timestamp{std::chrono::milliseconds{milliseconds}};
}

MarkerDetections frame_at(int milliseconds, std::vector<double> columns_px) {
  MarkerDetections frame;
  frame.time = at_ms(milliseconds);
  for (const double column_px : columns_px) {
    MarkerDetection detection;
    detection.id = static_cast<int>(frame.detections.size());
    detection.corners_px[0].x() = column_px;
    frame.detections.push_back(detection);
  }
  return frame;
}

std::vector<Skip> skips_of(const std::vector<MarkerDetections>& frames) {
  SensorQueue queue{SensorSetup{}};
  for (const MarkerDetections& frame : frames)
    queue.add(frame);
  return queue.take_skips();
}

TEST(SensorQueue, AFrameThatRepeatsTheOneBeforeIsSkipped) {
  EXPECT_EQ(skips_of({frame_at(0, {10.0, 20.0}), frame_at(100, {10.0, 20.0}),
                      frame_at(200, {10.0, 20.0})}),
            (std::vector<Skip>{Skip::kFrameRepeated, Skip::kFrameRepeated}));
}

TEST(SensorQueue, AFrameThatDiffersAtAllIsUsed) {
  EXPECT_TRUE(skips_of({frame_at(0, {10.0}), frame_at(100, {10.0 + 1e-9}),
                        frame_at(200, {10.0, 20.0}), frame_at(300, {10.0})})
                  .empty());
}

TEST(SensorQueue, EmptyFramesMayFollowEachOther) {
  EXPECT_TRUE(skips_of({frame_at(0, {}), frame_at(100, {}), frame_at(200, {})}).empty());
}

}  // namespace
}  // namespace waymark

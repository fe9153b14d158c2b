// SPDX-License-Identifier: BSD-3-Clause
// Messages with finite, but physically impossible numbers are refused.
#include "common/messages/codec.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <vector>

namespace waymark {
namespace {

marker_detections_t one_detection() {
  marker_detections_t frame{};
  frame.num_detections = 1;
  frame.detections.resize(1, marker_detection_t{});
  frame.detections[0].orientation[0] = frame.detections[0].other_orientation[0] = 1.0;
  return frame;
}

map_tiles_t no_tiles() {
  map_tiles_t map{};
  map.num_parts = 1;
  map.tile_size_cells = 64;
  map.resolution_m = 0.05;
  return map;
}

planar_lidar_t three_beams() {
  planar_lidar_t lidar{};
  lidar.nranges = 3;
  lidar.ranges = {1.0F, 2.0F, 3.0F};
  return lidar;
}

/// Why a message is refused; it is encoded without a check, as by another sender.
template <class Type>
RejectReason reason_of(const Type& message) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(payload.data(), 0, message.getEncodedSize());
  return decode<Type>(payload).reason;
}

TEST(Bounds, PhysicallyImpossibleNumbersAreOutOfBounds) {
  for (const double absurd_m : {1.1e7, 1e308, -1e308}) {
    slam_estimate_t estimate{};
    EXPECT_EQ(reason_of(estimate), RejectReason::kNone);
    estimate.x_m = absurd_m;
    EXPECT_EQ(reason_of(estimate), RejectReason::kOutOfBounds) << absurd_m;
    marker_map_t markers{};
    markers.num_parts = markers.num_landmarks = 1;
    markers.landmarks.resize(1, marker_landmark_t{});
    EXPECT_EQ(reason_of(markers), RejectReason::kNone);
    markers.landmarks[0].y_m = absurd_m;
    EXPECT_EQ(reason_of(markers), RejectReason::kOutOfBounds) << absurd_m;
    marker_detections_t frame = one_detection();
    frame.detections[0].other_position_m[2] = absurd_m;
    EXPECT_EQ(reason_of(frame), RejectReason::kOutOfBounds) << absurd_m;
    map_tiles_t map = no_tiles();
    map.origin_y_m = absurd_m;
    EXPECT_EQ(reason_of(map), RejectReason::kOutOfBounds) << absurd_m;
    pose_graph_t graph{};
    graph.num_parts = graph.num_vertices = 1;
    graph.vertices = {{0.0, absurd_m, 0.0}};
    EXPECT_EQ(reason_of(graph), RejectReason::kOutOfBounds) << absurd_m;
  }
  for (const float absurd : {1.1e7F, 3e38F, -3e38F}) {
    pose2D_t pose{};
    pose.theta = absurd;
    EXPECT_EQ(reason_of(pose), RejectReason::kOutOfBounds) << absurd;
    trajectory_t trajectory{};
    trajectory.num_parts = trajectory.num_poses = 1;
    trajectory.poses = {pose};
    EXPECT_EQ(reason_of(trajectory), RejectReason::kOutOfBounds) << absurd;
    particles_t particles{};
    particles.num_particles = 1;
    particles.particles.resize(1, particle_t{});
    particles.particles[0].pose.x = absurd;
    EXPECT_EQ(reason_of(particles), RejectReason::kOutOfBounds) << absurd;
    twist2D_t command{};
    command.vx = absurd;
    EXPECT_EQ(reason_of(command), RejectReason::kOutOfBounds) << absurd;
  }
}

TEST(Bounds, RangesMayBeInfiniteOrInvalidButNotAbsurd) {
  using Limits = std::numeric_limits<float>;
  for (const float fine_m : {0.0F, 3.5F, 9999.0F, Limits::infinity(), Limits::quiet_NaN()}) {
    planar_lidar_t lidar = three_beams();
    lidar.ranges[1] = fine_m;
    EXPECT_EQ(reason_of(lidar), RejectReason::kNone) << fine_m;
  }
  for (const float absurd_m : {1.1e4F, 1e30F, -1e30F, Limits::max()}) {
    planar_lidar_t lidar = three_beams();
    lidar.ranges[1] = absurd_m;
    EXPECT_EQ(reason_of(lidar), RejectReason::kOutOfBounds) << absurd_m;
    lidar_t mbot{};
    mbot.num_ranges = 1;
    mbot.ranges = {absurd_m};
    mbot.thetas = mbot.intensities = {0.0F};
    mbot.times = {0};
    EXPECT_EQ(reason_of(mbot), RejectReason::kOutOfBounds) << absurd_m;
    mbot.ranges = {1.0F};
    EXPECT_EQ(reason_of(mbot), RejectReason::kNone);
  }
}

}  // namespace
}  // namespace waymark

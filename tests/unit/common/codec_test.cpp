// SPDX-License-Identifier: BSD-3-Clause
// Decoding of untrusted bytes: types of other projects, hostile bytes, semantic checks.
#include "common/messages/codec.hpp"

#include "common/messages/convert.hpp"
#include "common/random/random.hpp"

#include <bot_core/image_t.hpp>
#include <bot_core/planar_lidar_t.hpp>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <mbot_lcm_msgs/mbot_slam_reset_t.hpp>
#include <mbot_lcm_msgs/occupancy_grid_t.hpp>
#include <mbot_lcm_msgs/particles_t.hpp>
#include <mbot_lcm_msgs/pose2D_t.hpp>
#include <mbot_lcm_msgs/slam_status_t.hpp>
#include <mbot_lcm_msgs/twist2D_t.hpp>

#include <cmath>
#include <limits>

namespace waymark {
namespace {

constexpr std::size_t kHead = 16;  // fingerprint and utime

planar_lidar_t small_lidar() {
  planar_lidar_t m{};
  m.utime = 5;
  m.nranges = 3;
  m.ranges = {1.0F, 2.0F, std::numeric_limits<float>::infinity()};
  m.rad0 = -1.0F;
  m.radstep = 0.5F;
  return m;
}

marker_detections_t small_detections() {
  MarkerDetections detections{timestamp_from_us(7), 640, 480, {}};
  detections.detections.push_back({.id = 0});
  detections.detections.push_back({.id = 5});
  return to_detections_message(detections);
}

tick_t small_tick() {
  tick_t m{};
  m.participants = {"detector", "slam"};
  m.num_participants = 2;
  channel_content_t content{};
  content.channel = "LIDAR";
  content.hashes = {1, 2};
  content.count = 2;
  m.channels = {content};
  m.num_channels = 1;
  return m;
}

map_tiles_t small_map() {
  map_tiles_t m{};
  m.num_parts = 1;
  m.resolution_m = 0.05;
  m.tile_size_cells = 2;
  map_tile_t tile{};
  tile.tile_x = -3;
  tile.num_cells = 4;
  tile.occupancy = {-1, 0, 50, 100};
  tile.marker_ids = {-1, 0, 1, 2};
  m.tiles = {tile};
  m.num_tiles = 1;
  return m;
}

void put_int32(std::vector<std::uint8_t>& bytes, std::size_t offset, std::int32_t value) {
  for (int i = 0; i < 4; ++i) {
    bytes[offset + static_cast<std::size_t>(i)] =
        static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (24 - 8 * i));
  }
}

template <class Type>
std::vector<std::uint8_t> payload_of(Channel<Type> channel, const Type& message) {
  return encode(channel, message).payload;
}

template <class Type>
void expect_round_trip(Channel<Type> channel, const Type& message) {
  const auto payload = payload_of(channel, message);

  const auto decoded = decode<Type>(payload);

  ASSERT_TRUE(decoded.message) << channel.name << ": " << to_string(decoded.reason);
  EXPECT_EQ(payload_of(channel, *decoded.message), payload) << channel.name;
}

// LCM's fingerprint depends on field names and types only, so types with equal fields are the same
// on the wire: drivers, viewers and logs of bot_core and MBot work with our types.
TEST(Fingerprint, EqualsThatOfForeignTypesWithTheSameLayout) {
  EXPECT_EQ(planar_lidar_t::getHash(), bot_core::planar_lidar_t::getHash());
  EXPECT_EQ(image_t::getHash(), bot_core::image_t::getHash());
  EXPECT_EQ(pose2D_t::getHash(), mbot_lcm_msgs::pose2D_t::getHash());
  EXPECT_EQ(twist2D_t::getHash(), mbot_lcm_msgs::twist2D_t::getHash());
  EXPECT_EQ(occupancy_grid_t::getHash(), mbot_lcm_msgs::occupancy_grid_t::getHash());
  EXPECT_EQ(particles_t::getHash(), mbot_lcm_msgs::particles_t::getHash());
  EXPECT_EQ(slam_status_t::getHash(), mbot_lcm_msgs::slam_status_t::getHash());
  EXPECT_EQ(mbot_slam_reset_t::getHash(), mbot_lcm_msgs::mbot_slam_reset_t::getHash());
  // As found in logs of real MBots.
  EXPECT_EQ(static_cast<std::uint64_t>(lidar_t::getHash()), 0x89dc5b879a5056cfULL);
  EXPECT_EQ(static_cast<std::uint64_t>(pose2D_t::getHash()), 0x1f317af1246276acULL);
}

TEST(Codec, EveryTypeSurvivesARoundTrip) {
  expect_round_trip(channels::kLidar, small_lidar());
  expect_round_trip(channels::kMarkers, small_detections());
  expect_round_trip(channels::kTick, small_tick());
  expect_round_trip(channels::kSlamMap, small_map());
  expect_round_trip(channels::kOdometry, to_pose_message(timestamp_from_us(1), {1, 2, 3}));
  expect_round_trip(channels::kDriveCommand, twist2D_t{});
  expect_round_trip(channels::kSlamCorrection, correction_t{});
  command_t command{};
  command.name = "day_1";
  command.pose[1] = std::numeric_limits<double>::quiet_NaN();  // slam answers, decode() accepts it
  expect_round_trip(channels::kSlamCommand, command);
  reply_t reply{};
  reply.state = reply_t::STATE_REFUSED;
  reply.text = "no";
  expect_round_trip(channels::kSlamReply, reply);
  map_changes_t changes{};
  changes.num_changes = 2;
  changes.changes.resize(2, map_change_t{});
  for (map_change_t& change : changes.changes)
    change.kind = map_change_t::KIND_WALL_NEW;
  expect_round_trip(channels::kSlamChanges, changes);
  findings_t findings{};
  findings.num_findings = 1;
  findings.findings.resize(1, finding_t{});
  findings.findings[0].name = "odometry_stuck";
  findings.findings[0].share = 0.1;
  expect_round_trip(channels::kSlamFindings, findings);
  lidar_t mbot{};
  mbot.num_ranges = 2;
  mbot.ranges = mbot.thetas = mbot.intensities = {1.0F, 2.0F};
  mbot.times = {0, 1000};
  expect_round_trip(channels::kMbotLidar, mbot);
  image_t image{};
  image.width = image.height = 2;
  image.size = 3;
  image.data = {1, 2, 3};
  image_metadata_t metadata{};
  metadata.key = "exposure";
  metadata.n = 1;
  metadata.value = {9};
  image.metadata = {metadata};
  image.nmetadata = 1;
  expect_round_trip(channels::kCamera, image);
  slam_estimate_t estimate{};
  estimate.covariance[8] = 2.0;
  expect_round_trip(channels::kSlamEstimate, estimate);
  marker_map_t markers{};
  markers.num_parts = 1;
  markers.landmarks.resize(2);
  for (auto& landmark : markers.landmarks)
    landmark = marker_landmark_t{};
  markers.num_landmarks = 2;
  expect_round_trip(channels::kSlamMarkers, markers);
  trajectory_t trajectory{};
  trajectory.num_parts = 1;
  trajectory.poses.assign(2, pose2D_t{});
  trajectory.num_poses = 2;
  expect_round_trip(channels::kSlamTrajectory, trajectory);
  map_header_t header{};
  header.resolution_m = 0.05;
  header.marker_size_m = 0.4;
  header.marker_dictionary = "DICT_6X6_250";
  header.frame = "map";
  expect_round_trip(channels::kMapHeader, header);
  map_walls_t walls{};
  walls.num_parts = 1;
  walls.spacing_m = 0.25;
  wall_cell_t cell{};
  cell.column = -3;
  cell.count = 5.0;
  walls.cells.assign(2, cell);
  walls.num_cells = 2;
  expect_round_trip(channels::kMapWalls, walls);
  pose_graph_t graph{};
  graph.num_parts = 1;
  graph.vertices = {{1.0, 2.0, 3.0}, {2.0, 2.0, 3.0}};
  graph.num_vertices = 2;
  graph_edge_t edge{};
  edge.to_vertex = 1;
  graph.edges = {edge};
  graph.num_edges = 1;
  expect_round_trip(channels::kMapGraph, graph);
  expect_round_trip(channels::kMapCalibration, calibration_t{});
  particles_t particles{};
  particles.particles.assign(3, particle_t{});
  particles.num_particles = 3;
  expect_round_trip(channels::kSlamParticles, particles);
  annotated_scan_t scan{};
  scan.num_beams = 2;
  scan.ranges = scan.angles = {1.0F, 2.0F};
  scan.marker_ids = {-1, 0};
  expect_round_trip(channels::kSlamScan, scan);
  occupancy_grid_t grid{};
  grid.width = grid.height = 2;
  grid.num_cells = 4;
  grid.meters_per_cell = 0.05F;
  grid.cells = {0, 1, -1, 127};
  expect_round_trip(channels::kSlamGrid, grid);
  process_status_t status{};
  status.process = "slam";
  status.state = "lockstep";
  status.counters.assign(2, counter_t{});
  status.num_counters = 2;
  expect_round_trip(channels::kSlamStatus, status);
  slam_status_t mbot_status{};
  mbot_status.slam_mode = slam_status_t::MODE_FULL;
  mbot_status.map_path = "corridor.map.lcm";
  expect_round_trip(channels::kMbotSlamStatus, mbot_status);
  mbot_slam_reset_t reset{};
  reset.slam_map_location = "current.map";
  reset.retain_pose = 1;
  expect_round_trip(channels::kMbotSystemReset, reset);
  ack_t ack{};
  ack.who = "slam";
  ack.channels = small_tick().channels;
  ack.num_channels = 1;
  expect_round_trip(channels::kAck, ack);
}

// The rows of research/lcm.md A10 that throw, crash or allocate gigabytes in the generated
// decoders.
class HostileLength : public ::testing::TestWithParam<std::int32_t> {};

TEST_P(HostileLength, InTheBeamCountIsRefused) {
  auto payload = payload_of(channels::kLidar, small_lidar());
  put_int32(payload, kHead, GetParam());
  const auto decoded = decode<planar_lidar_t>(payload);
  EXPECT_FALSE(decoded.message);
  EXPECT_THAT(decoded.reason, ::testing::AnyOf(RejectReason::kBadLength, RejectReason::kTruncated,
                                               RejectReason::kTrailingBytes));
}

TEST_P(HostileLength, InTheNumberOfStructsIsRefused) {
  auto payload = payload_of(channels::kMarkers, small_detections());
  put_int32(payload, kHead + 8, GetParam());
  EXPECT_FALSE(decode<marker_detections_t>(payload).message);
}

TEST_P(HostileLength, InTheNumberOfStringsIsRefused) {
  auto payload = payload_of(channels::kTick, small_tick());
  put_int32(payload, kHead + 25, GetParam());
  EXPECT_FALSE(decode<tick_t>(payload).message);
}

TEST_P(HostileLength, InAStringIsRefused) {
  auto payload = payload_of(channels::kTick, small_tick());
  put_int32(payload, kHead + 29, GetParam());
  EXPECT_FALSE(decode<tick_t>(payload).message);
}

INSTANTIATE_TEST_SUITE_P(ResearchA10, HostileLength,
                         ::testing::Values(-1, std::numeric_limits<std::int32_t>::min(), 0, 1, -5,
                                           0x1fffffff, 0x40000000, 0x7fffffff, 200'000'000,
                                           50'000'000));

TEST(Codec, TruncatedEmptyLongAndForeignBytesAreRefused) {
  auto payload = payload_of(channels::kLidar, small_lidar());
  for (std::size_t size = 0; size < payload.size(); ++size) {
    EXPECT_FALSE(decode<planar_lidar_t>(std::span{payload}.first(size)).message) << size;
  }
  EXPECT_EQ(decode<twist2D_t>(payload).reason, RejectReason::kWrongType);
  payload.resize(payload.size() + 100);
  EXPECT_EQ(decode<planar_lidar_t>(payload).reason, RejectReason::kTrailingBytes);
  EXPECT_EQ(decode<planar_lidar_t>(std::vector<std::uint8_t>(std::size_t{20} << 20)).reason,
            RejectReason::kTooLarge);
}

// What decode() accepts must encode to the same bytes. This oracle shares no code with the check of
// lengths.
TEST(Codec, MutatedBytesAreRefusedOrEncodeToTheSameBytes) {
  Random random{{1, 2}};
  const auto original = payload_of(channels::kTick, small_tick());
  int accepted = 0;
  for (int i = 0; i < 20000; ++i) {
    auto payload = original;
    const auto num_changes = 1 + random() % 4;
    for (std::uint64_t k = 0; k < num_changes; ++k) {
      payload[8 + random() % (payload.size() - 8)] = static_cast<std::uint8_t>(random());
    }
    const auto decoded = decode<tick_t>(payload);
    if (!decoded.message) continue;
    ++accepted;
    EXPECT_EQ(payload_of(channels::kTick, *decoded.message), payload);
  }
  EXPECT_GT(accepted, 1000);  // changed numbers and letters are valid, too
}

TEST(Codec, RejectsImplausibleValues) {
  planar_lidar_t lidar = small_lidar();
  lidar.radstep = std::numeric_limits<float>::quiet_NaN();
  EXPECT_THROW(encode(channels::kLidar, lidar), std::logic_error);
  lidar = small_lidar();
  lidar.nintensities = 2;
  lidar.intensities = {1.0F, 2.0F};
  EXPECT_THROW(encode(channels::kLidar, lidar), std::logic_error);
  lidar = small_lidar();
  lidar.nranges = 4;  // more than the vector holds: the generated encoder would read beyond its end
  EXPECT_THROW(encode(channels::kLidar, lidar), std::logic_error);

  auto payload = payload_of(channels::kOdometry, to_pose_message(timestamp_from_us(1), {}));
  put_int32(payload, 16, 0x7fc00000);  // x = NaN
  EXPECT_EQ(decode<pose2D_t>(payload).reason, RejectReason::kNotFinite);
  payload = payload_of(channels::kOdometry, to_pose_message(timestamp_from_us(1), {}));
  put_int32(payload, 8, -1);  // utime < 0
  EXPECT_EQ(decode<pose2D_t>(payload).reason, RejectReason::kBadTime);
  put_int32(payload, 8, 0x7fffffff);
  EXPECT_EQ(decode<pose2D_t>(payload).reason, RejectReason::kBadTime);
  EXPECT_FALSE(time_of(payload));
}

TEST(Codec, TilesBeyondTheLargestMapIndexAreRefused) {
  using Limits = std::numeric_limits<std::int32_t>;
  for (const std::int32_t far_index : {Limits::min(), Limits::max()}) {
    map_tiles_t map = small_map();
    map.tiles[0].tile_x = far_index;
    EXPECT_THROW(encode(channels::kSlamMap, map), std::logic_error) << far_index;
    map = small_map();
    map.tiles[0].tile_y = far_index;
    EXPECT_THROW(encode(channels::kSlamMap, map), std::logic_error) << far_index;
  }
}

TEST(Convert, APlanarScanHasAnAngleForEachRange) {
  planar_lidar_t m{};
  m.nranges = 3;
  m.ranges = {1.0F, 2.0F, 3.0F};
  m.rad0 = -0.5F;
  m.radstep = 0.25F;
  EXPECT_EQ(to_scan(m).angles_rad, (std::vector<double>{-0.5, -0.25, 0.0}));
}

TEST(Convert, AnMbotScansAnglesAreNegatedAndItsZeroRangesAreNoReturns) {
  lidar_t m{};
  m.utime = 100;
  m.num_ranges = 2;
  m.ranges = {0.0F, 2.0F};
  m.thetas = {0.0F, 0.5F};
  m.times = {100, 300};
  m.intensities = {0.0F, 0.0F};

  const LidarScan scan = to_scan(m);

  EXPECT_TRUE(std::isinf(scan.ranges_m[0]));
  EXPECT_EQ(scan.angles_rad[1], -0.5);
  EXPECT_EQ(scan.beam_time_offsets[1], Duration{200});
}

TEST(Convert, ADetectionKeepsItsPoseAndCovariance) {
  MarkerDetection detection{.id = 0, .width_px = 12.5};
  detection.base_from_marker =
      Eigen::Translation3d{1, 2, 3} * Eigen::AngleAxisd{0.7, Eigen::Vector3d{1, 2, 3}.normalized()};
  detection.covariance_in_base(1, 4) = 0.25;
  detection.corners_px[2] = {3.5, 4.5};

  const auto again =
      to_detections(to_detections_message({timestamp_from_us(3), 640, 480, {detection}}));

  const MarkerDetection& same = again.detections.at(0);
  EXPECT_EQ(same.id, 0);
  EXPECT_TRUE(same.base_from_marker.isApprox(detection.base_from_marker, 1e-12));
  EXPECT_EQ(same.covariance_in_base, detection.covariance_in_base);
  EXPECT_EQ(same.corners_px[2], detection.corners_px[2]);
}

}  // namespace
}  // namespace waymark

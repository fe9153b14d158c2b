// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/layout.hpp"

#include "common/bytes/big_endian.hpp"
#include "common/messages/channels.hpp"

#include <algorithm>
#include <array>
#include <map>

namespace waymark {
namespace {

constexpr int kMaxFields = 16;

/// Moves `offset` past one string: int32 length with the terminating zero, then the bytes.
RejectReason walk_string(std::span<const std::uint8_t> body, std::size_t& offset) {
  if (body.size() - offset < 4) return RejectReason::kTruncated;
  const auto length = read_big_endian<std::int32_t>(&body[offset]);
  offset += 4;
  if (length < 1) return RejectReason::kBadLength;
  if (body.size() - offset < static_cast<std::size_t>(length)) return RejectReason::kTruncated;
  const auto text = body.subspan(offset, static_cast<std::size_t>(length));
  offset += text.size();
  // One zero, at the end: LCM's encoder treats strings as C strings.
  const bool is_c_string = std::ranges::find(text, 0) == text.end() - 1;
  return is_c_string ? RejectReason::kNone : RejectReason::kBadLength;
}

RejectReason walk_struct(std::span<const std::uint8_t> body, StructLayout layout,
                         std::size_t& offset);

RejectReason walk_field(std::span<const std::uint8_t> body, const FieldLayout& field,
                        std::int64_t count, std::size_t& offset) {
  if (count < 0) return RejectReason::kBadLength;
  if (field.kind == FieldLayout::Kind::kFixed) {
    const auto elements_left = static_cast<std::int64_t>(
        (body.size() - offset) / static_cast<std::size_t>(field.element_bytes));
    if (count > elements_left) return RejectReason::kTruncated;
    offset += static_cast<std::size_t>(count * field.element_bytes);
    return RejectReason::kNone;
  }
  for (std::int64_t i = 0; i < count; ++i) {
    const RejectReason reason = field.kind == FieldLayout::Kind::kString
                                    ? walk_string(body, offset)
                                    : walk_struct(body, field.struct_fields, offset);
    if (reason != RejectReason::kNone) return reason;
  }
  return RejectReason::kNone;
}

RejectReason walk_struct(std::span<const std::uint8_t> body, StructLayout layout,
                         std::size_t& offset) {
  std::array<std::int32_t, kMaxFields> int32_values{};
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const FieldLayout& field = layout[i];
    const std::int64_t count = field.count_field < 0
                                   ? field.count
                                   : int32_values[static_cast<std::size_t>(field.count_field)];
    const std::size_t start = offset;
    const RejectReason reason = walk_field(body, field, count, offset);
    if (reason != RejectReason::kNone) return reason;
    if (field.kind == FieldLayout::Kind::kFixed && field.element_bytes == 4 && count == 1) {
      int32_values[i] = read_big_endian<std::int32_t>(&body[start]);
    }
  }
  return RejectReason::kNone;
}

// Short forms for the tables below.
constexpr FieldLayout fixed(int element_bytes, int count = 1) {
  return {.element_bytes = element_bytes, .count = count};
}

constexpr FieldLayout fixed_array(int element_bytes, int count_field) {
  return {.element_bytes = element_bytes, .count_field = count_field};
}

constexpr FieldLayout text() {
  return {.kind = FieldLayout::Kind::kString};
}

constexpr FieldLayout texts(int count_field) {
  return {.kind = FieldLayout::Kind::kString, .count_field = count_field};
}

constexpr FieldLayout one(StructLayout layout) {
  return {.kind = FieldLayout::Kind::kStruct, .struct_fields = layout};
}

constexpr FieldLayout many(StructLayout layout, int count_field) {
  return {.kind = FieldLayout::Kind::kStruct, .count_field = count_field, .struct_fields = layout};
}

constexpr int kByte = 1;
constexpr int kInt16 = 2;
constexpr int kInt32 = 4;
constexpr int kInt64 = 8;
constexpr int kFloat = 4;
constexpr int kDouble = 8;

// One table per type, fields in the order of lcmtypes/*.lcm; a test compares each with encoded
// messages.
constexpr FieldLayout kPlanarLidar[] = {
    fixed(kInt64),          fixed(kInt32), fixed_array(kFloat, 1), fixed(kInt32),
    fixed_array(kFloat, 3), fixed(kFloat), fixed(kFloat)};
constexpr FieldLayout kLidar[] = {
    fixed(kInt64),          fixed(kInt32),          fixed_array(kFloat, 1),
    fixed_array(kFloat, 1), fixed_array(kInt64, 1), fixed_array(kFloat, 1),
};
constexpr FieldLayout kImageMetadata[] = {text(), fixed(kInt32), fixed_array(kByte, 1)};
constexpr FieldLayout kImage[] = {fixed(kInt64),         fixed(kInt32), fixed(kInt32),
                                  fixed(kInt32),         fixed(kInt32), fixed(kInt32),
                                  fixed_array(kByte, 5), fixed(kInt32), many(kImageMetadata, 7)};
constexpr FieldLayout kPose2D[] = {fixed(kInt64), fixed(kFloat, 3)};
constexpr FieldLayout kTwist2D[] = {fixed(kInt64), fixed(kFloat, 3)};
constexpr FieldLayout kOccupancyGrid[] = {fixed(kInt64), fixed(kFloat, 3), fixed(kInt32),
                                          fixed(kInt32), fixed(kInt32),    fixed_array(kByte, 4)};
constexpr FieldLayout kParticle[] = {one(kPose2D), one(kPose2D), fixed(kDouble)};
constexpr FieldLayout kParticles[] = {fixed(kInt64), fixed(kInt32), many(kParticle, 1)};
constexpr FieldLayout kTrajectory[] = {fixed(kInt64, 2), fixed(kInt32), fixed(kInt32),
                                       fixed(kInt32), many(kPose2D, 3)};
constexpr FieldLayout kMarkerDetection[] = {
    fixed(kInt32),  fixed(kDouble, 8), fixed(kDouble, 3), fixed(kDouble, 4), fixed(kDouble, 36),
    fixed(kDouble), fixed(kDouble, 3), fixed(kDouble, 4), fixed(kDouble),    fixed(kDouble)};
constexpr FieldLayout kMarkerDetections[] = {fixed(kInt64), fixed(kInt32), fixed(kInt32),
                                             fixed(kInt32), many(kMarkerDetection, 3)};
constexpr FieldLayout kSlamEstimate[] = {
    fixed(kInt64, 2),  fixed(kByte),   fixed(kDouble, 3), fixed(kDouble, 9), fixed(kByte),
    fixed(kInt32),     fixed(kDouble), fixed(kInt32),     fixed(kInt32),     fixed(kDouble, 9),
    fixed(kDouble, 3), fixed(kDouble), fixed(kByte)};
constexpr FieldLayout kMapTile[] = {fixed(kInt32), fixed(kInt32), fixed(kInt32),
                                    fixed_array(kByte, 2), fixed_array(kInt16, 2)};
constexpr FieldLayout kMapTiles[] = {fixed(kInt64, 2),  fixed(kInt32), fixed(kInt32),
                                     fixed(kDouble, 3), fixed(kInt32), fixed(kInt32),
                                     many(kMapTile, 5)};
constexpr FieldLayout kMarkerLandmark[] = {fixed(kInt32),     fixed(kInt32), fixed(kDouble, 3),
                                           fixed(kDouble, 9), fixed(kInt32), fixed(kInt64, 2),
                                           fixed(kByte)};
constexpr FieldLayout kMarkerMap[] = {fixed(kInt64, 2), fixed(kInt32), fixed(kInt32), fixed(kInt32),
                                      many(kMarkerLandmark, 3)};
constexpr FieldLayout kMapHeader[] = {fixed(kInt64, 3),  fixed(kInt32), fixed(kInt32),
                                      fixed(kDouble, 2), text(),        text()};
constexpr FieldLayout kWallCell[] = {fixed(kInt32), fixed(kInt32), fixed(kDouble),
                                     fixed(kDouble, 2), fixed(kDouble, 3)};
constexpr FieldLayout kMapWalls[] = {fixed(kInt64),  fixed(kInt32), fixed(kInt32),
                                     fixed(kDouble), fixed(kInt32), many(kWallCell, 4)};
constexpr FieldLayout kVertex[] = {fixed(kDouble, 3)};
constexpr FieldLayout kGraphEdge[] = {fixed(kInt32), fixed(kInt32), fixed(kDouble, 3),
                                      fixed(kDouble, 6)};
constexpr FieldLayout kPoseGraph[] = {fixed(kInt64),      fixed(kInt32),    fixed(kInt32),
                                      fixed(kInt32),      many(kVertex, 3), fixed(kInt32),
                                      many(kGraphEdge, 5)};
constexpr FieldLayout kCorrection[] = {fixed(kInt64, 2), fixed(kDouble, 3), fixed(kDouble, 9),
                                       fixed(kByte),     fixed(kDouble, 3), fixed(kByte)};
constexpr FieldLayout kCommand[] = {fixed(kInt64, 2),  fixed(kByte, 2),   text(),
                                    fixed(kDouble, 3), fixed(kDouble, 2), fixed(kByte)};
constexpr FieldLayout kReply[] = {fixed(kInt64, 2), fixed(kByte), text()};
constexpr FieldLayout kMapChange[] = {fixed(kByte), fixed(kInt32), fixed(kInt32), fixed(kDouble, 7),
                                      fixed(kInt32)};
constexpr FieldLayout kMapChanges[] = {fixed(kInt64, 2), fixed(kInt32), many(kMapChange, 1)};
constexpr FieldLayout kFinding[] = {text(), text(), fixed(kDouble, 2)};
constexpr FieldLayout kFindings[] = {fixed(kInt64, 2), fixed(kInt32), many(kFinding, 1)};
constexpr FieldLayout kCalibration[] = {fixed(kInt64, 2), fixed(kDouble, 8), fixed(kDouble, 64)};
constexpr FieldLayout kAnnotatedScan[] = {fixed(kInt64),          fixed(kDouble, 3),
                                          fixed(kInt32),          fixed_array(kFloat, 2),
                                          fixed_array(kFloat, 2), fixed_array(kInt32, 2)};
constexpr FieldLayout kCounter[] = {text(), fixed(kByte), fixed(kInt64)};
constexpr FieldLayout kProcessStatus[] = {fixed(kInt64), text(), text(), fixed(kInt32),
                                          many(kCounter, 3)};
constexpr FieldLayout kSlamStatus[] = {fixed(kInt64), fixed(kInt32), text()};
constexpr FieldLayout kMbotSlamReset[] = {fixed(kInt64), fixed(kInt32), text(), fixed(kByte)};
constexpr FieldLayout kChannelContent[] = {text(), fixed(kInt32), fixed_array(kInt64, 1)};
constexpr FieldLayout kTick[] = {fixed(kInt64), fixed(kInt64), fixed(kInt64),
                                 fixed(kInt64), fixed(kByte),  fixed(kInt32),
                                 texts(5),      fixed(kInt32), many(kChannelContent, 7)};
constexpr FieldLayout kAck[] = {fixed(kInt64), fixed(kInt64), fixed(kInt64),           text(),
                                fixed(kInt64), fixed(kInt32), many(kChannelContent, 5)};

}  // namespace

RejectReason walk(std::span<const std::uint8_t> body, StructLayout layout) {
  std::size_t offset = 0;
  const RejectReason reason = walk_struct(body, layout, offset);
  if (reason != RejectReason::kNone) return reason;
  return offset == body.size() ? RejectReason::kNone : RejectReason::kTrailingBytes;
}

StructLayout layout_of(std::int64_t fingerprint) {
  static const std::map<std::int64_t, StructLayout> layouts{
      {ack_t::getHash(), kAck},
      {annotated_scan_t::getHash(), kAnnotatedScan},
      {calibration_t::getHash(), kCalibration},
      {command_t::getHash(), kCommand},
      {correction_t::getHash(), kCorrection},
      {findings_t::getHash(), kFindings},
      {image_t::getHash(), kImage},
      {lidar_t::getHash(), kLidar},
      {map_changes_t::getHash(), kMapChanges},
      {map_header_t::getHash(), kMapHeader},
      {map_tiles_t::getHash(), kMapTiles},
      {map_walls_t::getHash(), kMapWalls},
      {marker_detections_t::getHash(), kMarkerDetections},
      {marker_map_t::getHash(), kMarkerMap},
      {mbot_slam_reset_t::getHash(), kMbotSlamReset},
      {occupancy_grid_t::getHash(), kOccupancyGrid},
      {particles_t::getHash(), kParticles},
      {planar_lidar_t::getHash(), kPlanarLidar},
      {pose2D_t::getHash(), kPose2D},
      {pose_graph_t::getHash(), kPoseGraph},
      {process_status_t::getHash(), kProcessStatus},
      {reply_t::getHash(), kReply},
      {slam_estimate_t::getHash(), kSlamEstimate},
      {slam_status_t::getHash(), kSlamStatus},
      {tick_t::getHash(), kTick},
      {trajectory_t::getHash(), kTrajectory},
      {twist2D_t::getHash(), kTwist2D},
  };
  return layouts.at(fingerprint);
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/foreign_messages.hpp"

#include "common/bytes/big_endian.hpp"
#include "common/messages/bounds.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"

#include <fmt/format.h>

#include <array>
#include <bit>
#include <cmath>

namespace waymark {
namespace {

constexpr std::uint64_t kMaebotEncoders = 0x7d090bfb221d74f9ULL;
// MAEBots of 2014: {int64 utime, int32 left, int32 right, motor commands, currents}
constexpr std::uint64_t kMaebotMotorFeedback = 0x8dc5a028fca42ff9ULL;
// {int64 utime, double pos[3], vel[3], orientation[4], rotation_rate[3], accel[3]}
constexpr std::uint64_t kBotCorePose = 0x2e16efb052b0105eULL;
constexpr std::size_t kEncodersBytes = 8 + 8 + 2 * 4;
constexpr std::size_t kBotCorePoseBytes = 8 + 8 + 16 * 8;
constexpr std::size_t kBodyOffset = 16;  // behind fingerprint and utime

double read_double(std::span<const std::uint8_t> payload, std::size_t index) {
  return std::bit_cast<double>(read_big_endian<std::uint64_t>(&payload[kBodyOffset + 8 * index]));
}

bool has_type(std::span<const std::uint8_t> payload, std::uint64_t fingerprint) {
  return static_cast<std::uint64_t>(fingerprint_of(payload)) == fingerprint;
}

LineProblem wrong_size(std::span<const std::uint8_t> payload, std::size_t expected) {
  return {"wrong size", fmt::format("{} bytes instead of {}", payload.size(), expected)};
}

PoseResult read_bot_core_pose(std::span<const std::uint8_t> payload) {
  if (payload.size() != kBotCorePoseBytes) return wrong_size(payload, kBotCorePoseBytes);
  const auto time = time_of(payload);
  if (!time) return LineProblem{"bad time", "utime is negative or far in the future"};
  constexpr std::size_t kOrientation = 6;  // behind pos and vel
  std::array<double, 4> q{};
  for (std::size_t i = 0; i < q.size(); ++i)
    q[i] = read_double(payload, kOrientation + i);
  const auto [w, x, y, z] = q;
  const double yaw_rad = std::atan2(2.0 * (w * z + x * y), w * w + x * x - y * y - z * z);
  const Se2 pose{read_double(payload, 0), read_double(payload, 1), yaw_rad};
  const double norm = w * w + x * x + y * y + z * z;
  if (!(std::abs(norm - 1.0) < 1e-3)) {
    return LineProblem{"bad orientation", fmt::format("a quaternion of squared norm {}", norm)};
  }
  return ForeignPose{*time, pose};
}

PoseResult read_planar_pose(std::span<const std::uint8_t> payload) {
  const Decoded<pose2D_t> decoded = decode<pose2D_t>(payload);
  if (!decoded.message) {
    return LineProblem{"bad pose message", std::string{to_string(decoded.reason)}};
  }
  return ForeignPose{timestamp_from_us(decoded.message->utime), to_se2(*decoded.message)};
}

/// Larger coordinates are garbage.
bool is_plausible(const Se2& pose) {
  return std::abs(pose.x()) <= bounds::kPosition_m && std::abs(pose.y()) <= bounds::kPosition_m &&
         std::isfinite(pose.theta());
}

}  // namespace

LineProblem unknown_type(std::span<const std::uint8_t> payload) {
  return {"unknown type",
          fmt::format("fingerprint {:016x}, {} bytes",
                      static_cast<std::uint64_t>(fingerprint_of(payload)), payload.size())};
}

ForeignKind kind_of(std::span<const std::uint8_t> payload) {
  if (has_type(payload, kMaebotEncoders) || has_type(payload, kMaebotMotorFeedback))
    return ForeignKind::kTicks;
  const bool is_pose =
      fingerprint_of(payload) == pose2D_t::getHash() || has_type(payload, kBotCorePose);
  return is_pose ? ForeignKind::kPose : ForeignKind::kOther;
}

EncoderResult read_encoders(std::span<const std::uint8_t> payload) {
  const bool is_feedback = has_type(payload, kMaebotMotorFeedback);
  if (!is_feedback && !has_type(payload, kMaebotEncoders)) return unknown_type(payload);
  const bool is_whole =
      is_feedback ? payload.size() >= kEncodersBytes : payload.size() == kEncodersBytes;
  if (!is_whole) return wrong_size(payload, kEncodersBytes);
  const auto time = time_of(payload);
  if (!time) return LineProblem{"bad time", "utime is negative or far in the future"};
  return EncoderTicks{*time, 0, read_big_endian<std::int32_t>(&payload[kBodyOffset]),
                      read_big_endian<std::int32_t>(&payload[kBodyOffset + 4]),
                      is_feedback ? RobotModel::kMaebot2014 : RobotModel::kMaebot};
}

PoseResult read_pose(std::span<const std::uint8_t> payload) {
  const bool is_planar = fingerprint_of(payload) == pose2D_t::getHash();
  if (!is_planar && !has_type(payload, kBotCorePose)) return unknown_type(payload);
  PoseResult result = is_planar ? read_planar_pose(payload) : read_bot_core_pose(payload);
  const auto* pose = std::get_if<ForeignPose>(&result);
  if (pose != nullptr && !is_plausible(pose->pose)) {
    return LineProblem{"number out of range", "coordinates that are not finite or beyond 1000 km"};
  }
  return result;
}

}  // namespace waymark

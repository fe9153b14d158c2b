// SPDX-License-Identifier: BSD-3-Clause
// LCM messages of other robots that are not types of ours, read field by field. LCM's fingerprint
// ignores the names of packages and structs, so pose_xyt_t and odometry_t of MBot robots are our
// pose2D_t.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <cstdint>
#include <span>
#include <string>
#include <variant>

namespace waymark {

/// Which robot's wheels the ticks are of.
enum class Encoders {
  kMaebot,      ///< MAEBOT_ENCODERS
  kMaebot2014,  ///< MAEBOT_MOTOR_FEEDBACK, whose further fields are not read
};

/// MAEBot: int64 utime, int32 left, int32 right: ticks since power-on, which may wrap around.
struct EncoderTicks {
  Timestamp time{};
  std::int64_t at{0};
  std::int32_t left{0};
  std::int32_t right{0};
  Encoders encoders{Encoders::kMaebot};
};

struct ForeignPose {
  Timestamp time{};
  Se2 pose{};
};

using EncoderResult = std::variant<EncoderTicks, LineProblem>;
using PoseResult = std::variant<ForeignPose, LineProblem>;

enum class ForeignKind { kOther, kTicks, kPose };

/// By its fingerprint; the rest may be damaged.
ForeignKind kind_of(std::span<const std::uint8_t> payload);

/// For any bytes. `at` is left 0.
EncoderResult read_encoders(std::span<const std::uint8_t> payload);

/// pose2D_t, or bot_core.pose_t (position and the yaw of its w x y z quaternion).
PoseResult read_pose(std::span<const std::uint8_t> payload);

/// "unknown type" with the fingerprint in hexadecimal.
LineProblem unknown_type(std::span<const std::uint8_t> payload);

}  // namespace waymark

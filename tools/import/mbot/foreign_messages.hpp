// SPDX-License-Identifier: BSD-3-Clause
// LCM messages of other robots whose types are not in lcmtypes/, decoded field by field. LCM's
// fingerprint ignores package and struct names, so pose_xyt_t and odometry_t of MBot robots decode
// as pose2D_t.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/time/time.hpp"
#include "import/log/import_report.hpp"

#include <cstdint>
#include <span>
#include <variant>

namespace waymark {

/// Robot model, recognised by the type of its encoder messages.
enum class RobotModel {
  kMaebot,      ///< MAEBOT_ENCODERS
  kMaebot2014,  ///< MAEBOT_MOTOR_FEEDBACK, whose further fields are not read
};

/// Encoder ticks since power-on; the counters may wrap around.
struct EncoderTicks {
  Timestamp time{};
  std::int64_t at{0};
  std::int32_t left{0};
  std::int32_t right{0};
  RobotModel robot_model{RobotModel::kMaebot};
};

struct ForeignPose {
  Timestamp time{};
  Se2 pose{};
};

using EncoderResult = std::variant<EncoderTicks, LineProblem>;
using PoseResult = std::variant<ForeignPose, LineProblem>;

enum class ForeignKind { kOther, kTicks, kPose };

/// Kind of message by its fingerprint only; the rest may be damaged.
ForeignKind kind_of(std::span<const std::uint8_t> payload);

/// Accepts any bytes. Leaves `at` 0.
EncoderResult read_encoders(std::span<const std::uint8_t> payload);

/// Accepts pose2D_t, and bot_core.pose_t (x, y, and the yaw of its quaternion w x y z).
PoseResult read_pose(std::span<const std::uint8_t> payload);

/// "unknown type" with the fingerprint in hexadecimal.
LineProblem unknown_type(std::span<const std::uint8_t> payload);

}  // namespace waymark

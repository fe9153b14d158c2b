// SPDX-License-Identifier: BSD-3-Clause
// Wheel odometry with its errors, integrated from wheel angles; the true pose is not used.
#pragma once

#include "common/config/config.hpp"
#include "common/random/random.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "sim/core/robot/physics.hpp"

#include <cstdint>

namespace waymark {

/// Errors of the odometry.
struct OdometryErrorConfig {
  bool draw_from_seed{true};
  double scale{0.0};
  double heading_scale{0.0};
  double diffusion_m_per_sqrt_m{0.003};
  double heading_diffusion_deg_per_sqrt_m{0.5};
  double slips_per_m{0.0};
  double slip_m{0.02};
  int ticks_per_turn{4096};

  void describe(Fields& fields);
};

/// The configured errors; with draw_from_seed, `scale` is replaced by +1 % on odd and -1 % on even
/// seeds, and `heading_scale` by a random value within +-0.5 %.
OdometryErrorConfig errors_of_seed(const OdometryErrorConfig& config, std::int64_t seed);

/// Integrates wheel angles, with the errors of the odometry, to a pose that starts at the identity.
class WheelOdometry {
 public:
  WheelOdometry(const BaseConfig& base, const OdometryErrorConfig& errors, std::int64_t seed);

  /// Call at the odometry rate, in order of time.
  /// @param angles  angles [rad] of the wheels since the start.
  OdometrySample measure(Timestamp time, const WheelPair& angles);

 private:
  double counted_angle_rad(double angle_rad) const;
  double slip_m(double distance_m, Random& random) const;

  BaseConfig base_;
  OdometryErrorConfig errors_;
  std::uint64_t seed_;
  std::uint64_t step_{0};
  WheelPair last_{};
  Se2 odom_from_base_{};
};

}  // namespace waymark

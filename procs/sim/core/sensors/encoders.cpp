// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/sensors/encoders.hpp"

#include "sim/core/random_streams.hpp"

#include <cmath>
#include <numbers>

namespace waymark {
namespace {

// Sizes of the constant errors drawn from the seed: those of a well-kept TurtleBot3.
constexpr double kScaleOfOddSeeds = 0.01;
constexpr double kMaxHeadingScale = 0.005;

}  // namespace

void OdometryErrorConfig::describe(Fields& fields) {
  fields.field("draw_from_seed", draw_from_seed,
               "scale +0.01 on odd seeds, -0.01 on even ones; heading_scale drawn in +-0.005");
  fields.field("scale", scale, {-0.5, 0.5},
               "share by which distances are measured too long; with draw_from_seed = false");
  fields.field("heading_scale", heading_scale, {-0.5, 0.5},
               "share by which turns are measured too large (wrong wheel base); with "
               "draw_from_seed = false");
  fields.field("diffusion_m_per_sqrt_m", diffusion_m_per_sqrt_m, kNotNegative,
               "standard deviation of the distance after one metre; grows with its square root");
  fields.field("heading_diffusion_deg_per_sqrt_m", heading_diffusion_deg_per_sqrt_m, kNotNegative,
               "standard deviation of the heading after one metre");
  fields.field("slips_per_m", slips_per_m, kNotNegative, "how often the wheels spin, on average");
  fields.field("slip_m", slip_m, kNotNegative, "mean distance that a slip adds to the odometry");
  fields.field("ticks_per_turn", ticks_per_turn, {0, 1000000},
               "encoder resolution; 0 = unlimited. XM430: 4096");
}

OdometryErrorConfig errors_of_seed(const OdometryErrorConfig& config, std::int64_t seed) {
  OdometryErrorConfig errors = config;
  if (!config.draw_from_seed) return errors;
  Random random{static_cast<std::uint64_t>(seed), random_streams::kOdometryConstants};
  errors.scale = seed % 2 != 0 ? kScaleOfOddSeeds : -kScaleOfOddSeeds;
  errors.heading_scale = random.uniform(-kMaxHeadingScale, kMaxHeadingScale);
  return errors;
}

WheelOdometry::WheelOdometry(const BaseConfig& base, const OdometryErrorConfig& errors,
                             std::int64_t seed)
    : base_{base}, errors_{errors_of_seed(errors, seed)}, seed_{static_cast<std::uint64_t>(seed)} {}

double WheelOdometry::counted_angle_rad(double angle_rad) const {
  if (errors_.ticks_per_turn == 0) return angle_rad;
  const double tick_rad = 2.0 * std::numbers::pi / errors_.ticks_per_turn;
  return std::floor(angle_rad / tick_rad + 0.5) * tick_rad;
}

/// Slips are a Poisson process over the distance, with exponentially distributed lengths.
double WheelOdometry::slip_m(double distance_m, Random& random) const {
  const double chance = random.uniform();
  const double length_m = -std::log(1.0 - random.uniform()) * errors_.slip_m;
  return chance < errors_.slips_per_m * distance_m ? length_m : 0.0;
}

OdometrySample WheelOdometry::measure(Timestamp time, const WheelPair& angles) {
  const WheelPair counted{counted_angle_rad(angles.left), counted_angle_rad(angles.right)};
  const double left_m = (counted.left - last_.left) * base_.wheel_radius_m;
  const double right_m = (counted.right - last_.right) * base_.wheel_radius_m;
  last_ = counted;

  // Variances grow with the path, so that the errors do not depend on how often measure() is
  // called.
  const double path_m = 0.5 * (std::abs(left_m) + std::abs(right_m));
  Random random{seed_, random_streams::kOdometry, step_++};
  const double sqrt_path = std::sqrt(path_m);
  const double forward_m = 0.5 * (left_m + right_m) * (1.0 + errors_.scale) +
                           errors_.diffusion_m_per_sqrt_m * sqrt_path * random.normal() +
                           slip_m(path_m, random);
  const double turn_rad =
      (right_m - left_m) / base_.wheel_separation_m * (1.0 + errors_.heading_scale) +
      radians(errors_.heading_diffusion_deg_per_sqrt_m) * sqrt_path * random.normal();

  // Midpoint rule: the robot moves along the mean of its headings before and after the step.
  const Se2 half_turn{0.0, 0.0, 0.5 * turn_rad};
  odom_from_base_ = odom_from_base_ * half_turn * Se2{forward_m, 0.0, 0.0} * half_turn;
  return {time, odom_from_base_};
}

}  // namespace waymark

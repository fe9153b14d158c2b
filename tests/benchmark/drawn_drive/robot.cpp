// SPDX-License-Identifier: BSD-3-Clause
#include "drawn_drive/robot.hpp"

#include <algorithm>
#include <cmath>

namespace waymark::drawn {
namespace {

constexpr double kAhead_m = 0.5;  // of the point that is driven to

}  // namespace

void Robot::step(double speed_mps, const Routes& routes) {
  while (!has_arrived() && (way_[next_] - pose_.translation()).norm() < kAhead_m)
    ++next_;
  const Eigen::Vector2d target =
      way_.empty() ? pose_.translation() : way_[std::min(next_, way_.size() - 1)];
  const Eigen::Vector2d towards = pose_.inverse() * target;
  const double off_rad = std::atan2(towards.y(), towards.x());
  const double wanted_mps = std::abs(off_rad) > 0.7 ? 0.0 : speed_mps * (1.0 - std::abs(off_rad));
  speed_mps_ += std::clamp(wanted_mps - speed_mps_, -kStep_s, kStep_s);
  turn_rad_s_ +=
      std::clamp(std::clamp(2.0 * off_rad, -1.2, 1.2) - turn_rad_s_, -3.0 * kStep_s, 3.0 * kStep_s);
  last_step_ = {kStep_s * speed_mps_, 0.0, kStep_s * turn_rad_s_};
  if (routes.clearance_m((pose_ * last_step_).translation()) < 0.1) {
    speed_mps_ = 0.0;
    last_step_ = {0.0, 0.0, last_step_.theta()};
  }
  pose_ = pose_ * last_step_;
}

Odometry::Odometry(double noise, Random& random)
    : noise_{noise},
      scale_{1.0 + noise * random.normal(0.0, 0.01)},
      turn_scale_{1.0 + noise * random.normal(0.0, 0.02)},
      drift_rad_per_m_{noise * random.normal(0.0, 0.002)} {}

void Odometry::add(const Se2& step, Random& random) {
  const double way_m = std::abs(step.x());
  const double rolled_m = scale_ * step.x() + noise_ * random.normal(0.0, 0.02 * std::sqrt(way_m));
  const double turn_sigma_rad =
      std::hypot(0.012 * std::sqrt(way_m), 0.02 * std::sqrt(std::abs(step.theta())));
  const double turned_rad = turn_scale_ * step.theta() + drift_rad_per_m_ * way_m +
                            noise_ * random.normal(0.0, turn_sigma_rad);
  pose_ = pose_ * Se2{rolled_m, 0.0, turned_rad};
}

}  // namespace waymark::drawn

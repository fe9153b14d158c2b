// SPDX-License-Identifier: BSD-3-Clause
// A robot that drives along ways, and what its wheels say.
#pragma once

#include "common/geometry/se2.hpp"
#include "drawn_drive/routes.hpp"

#include <cstddef>
#include <utility>
#include <vector>

namespace waymark::drawn {

constexpr double kStep_s = 0.05;

class Robot {
 public:
  explicit Robot(const Eigen::Vector2d& place) : pose_{place, 0.0} {}

  bool has_arrived() const { return next_ >= way_.size(); }

  void follow(std::vector<Eigen::Vector2d> way) {
    way_ = std::move(way);
    next_ = 0;
  }

  /// For kStep_s.
  void step(double speed_mps, const Routes& routes);

  const Se2& pose() const { return pose_; }

  const Se2& last_step() const { return last_step_; }

 private:
  Se2 pose_;
  Se2 last_step_{};
  std::vector<Eigen::Vector2d> way_{};
  std::size_t next_{0};
  double speed_mps_{0.0};
  double turn_rad_s_{0.0};
};

/// With scales that are wrong, drift and noise.
class Odometry {
 public:
  /// @param noise  times that of a good robot.
  Odometry(double noise, Random& random);

  void add(const Se2& step, Random& random);

  const Se2& pose() const { return pose_; }

 private:
  double noise_;
  double scale_;
  double turn_scale_;
  double drift_rad_per_m_;
  Se2 pose_{};
};

}  // namespace waymark::drawn

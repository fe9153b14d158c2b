// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/motion_model.hpp"

namespace waymark {

Se2 sample_motion(const Motion& motion, const MotionNoise& noise, Random& random) {
  const double distance_m = motion.distance_m;
  const double along_m = noise.rotation_only
                             ? 0.0
                             : random.normal(0.0, noise.along_per_sqrt_m * std::sqrt(distance_m));

  // A random walk of the heading with variance q L over a path of length L displaces its end
  // sideways by L/2 times the final error, plus an independent part of variance q L^3 / 12
  // (integrated Brownian motion).
  const double by_distance_rad = random.normal(0.0, noise.turn_per_sqrt_m * std::sqrt(distance_m));
  const double sideways_m =
      0.5 * distance_m * by_distance_rad +
      random.normal(0.0, noise.turn_per_sqrt_m * distance_m * std::sqrt(distance_m / 12.0));
  const double by_turn_rad =
      random.normal(0.0, noise.turn_per_sqrt_rad * std::sqrt(motion.turn_rad));

  const Eigen::Vector2d straight = motion.start_from_end.translation();
  const double length_m = straight.norm();
  const Eigen::Vector2d forward =
      length_m > 0.0 ? Eigen::Vector2d{straight / length_m} : Eigen::Vector2d{1.0, 0.0};
  const Eigen::Vector2d left{-forward.y(), forward.x()};
  return {straight + along_m * forward + sideways_m * left,
          motion.start_from_end.theta() + by_distance_rad + by_turn_rad};
}

}  // namespace waymark

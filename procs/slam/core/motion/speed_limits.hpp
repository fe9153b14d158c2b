// SPDX-License-Identifier: BSD-3-Clause
// Speed limits of this robot, learnt from its steps so far.
#pragma once

#include "slam/core/motion/motion.hpp"

#include <array>
#include <cstddef>

namespace waymark {

/// A step is implausible if it is much faster than this robot's usual speed and needs a higher
/// acceleration than wheels can give. This is detected even in a bare corridor, where no other
/// sensor observes the motion.
class SpeedLimits {
 public:
  /// @param step  one step of the odometry, which took `step_s` seconds.
  /// @return whether it is plausible, given all previous steps.
  bool allow(const Motion& step, double step_s);

 private:
  /// Histogram of the speeds of steps in which the robot moved.
  class Usual {
   public:
    void add(double speed);
    double high() const;  ///< 95 % quantile

    int count() const { return count_; }

   private:
    static constexpr std::size_t kBins = 80;
    std::array<int, kBins> counts_{};
    int count_{0};
  };

  Usual drives_{};
  Usual turns_{};
  int refused_in_a_row_{0};
  double mean_step_s_{0.0};
  double last_step_s_{0.0};
  double drive_m_s_{0.0};  ///< speed in the newest accepted step
  double turn_rad_s_{0.0};
};

}  // namespace waymark

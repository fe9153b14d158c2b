// SPDX-License-Identifier: BSD-3-Clause
// Motions that this robot cannot have made.
#pragma once

#include "slam/core/motion/motion.hpp"

#include <array>
#include <cstddef>

namespace waymark {

/// A robot hardly ever drives much faster than it usually does, unless it gets there by an
/// acceleration that wheels have. Odometry that says so in one step is wrong, though along a bare
/// corridor nothing else contradicts it.
class SpeedLimits {
 public:
  /// @param step  one step of the odometry, that took `step_s` seconds.
  /// @return whether it is believable, given all steps before.
  bool allow(const Motion& step, double step_s);

 private:
  /// Counts of speeds by their size, of steps in which the robot moved.
  class Usual {
   public:
    void add(double speed);
    double high() const;  ///< hardly ever exceeded

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
  double drive_m_s_{0.0};  ///< of the newest step that was believed
  double turn_rad_s_{0.0};
};

}  // namespace waymark

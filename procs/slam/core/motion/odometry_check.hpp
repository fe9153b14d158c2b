// SPDX-License-Identifier: BSD-3-Clause
// Rejects steps of the odometry that this robot cannot have driven, and extrapolates instead.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/motion/speed_limits.hpp"

#include <vector>

namespace waymark {

class OdometryCheck {
 public:
  /// The step itself or, if it exceeds the robot's speed limits, the last estimated step: shortened
  /// in proportion if it took longer than `step_s`, and marked as a guess (Motion::guessed_s).
  ///
  /// @param has_caught_up  the step includes late motion, which took longer: it is accepted.
  Motion plausible(const Motion& step, double step_s, bool has_caught_up);

  /// Whether the last step was rejected.
  bool is_refused() const { return is_refused_; }

  /// To be called with the newest step as estimated.
  void note_estimated(const Se2& start_from_end, double step_s);

  /// Hypotheses of the motion since the last scan that do not rely on odometry's newest step: no
  /// motion, the last estimated step again, and the newest step if it was rejected.
  std::vector<Se2> steps_without_odometry() const;

 private:
  SpeedLimits limits_{};
  bool is_refused_{false};
  Se2 refused_step_{};
  Se2 last_step_{};  ///< as estimated
  double last_step_s_{0.0};
};

}  // namespace waymark

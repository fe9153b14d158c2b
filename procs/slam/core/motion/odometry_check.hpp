// SPDX-License-Identifier: BSD-3-Clause
// Steps of the odometry that are not believed, and what may have been driven instead.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/motion/speed_limits.hpp"

#include <vector>

namespace waymark {

class OdometryCheck {
 public:
  /// The step itself; or, where no robot can have driven it that has driven as this one, that it
  /// went on as before, vaguely.
  ///
  /// @param has_caught_up  odometry was stuck: the step took longer than it seems.
  Motion believable(const Motion& step, double step_s, bool has_caught_up);

  /// The last step was not believed.
  bool is_refused() const { return is_refused_; }

  /// The last step as it was estimated.
  void note_estimated(const Se2& start_from_end, double step_s);

  /// What may have been driven since the last scan, whatever odometry says of it: nothing, the
  /// step before once more, and what a gap in a log left over of a step that was refused.
  std::vector<Se2> steps_without_odometry() const;

 private:
  SpeedLimits limits_{};
  bool is_refused_{false};
  Se2 refused_step_{};
  Se2 last_step_{};  ///< as estimated
  double last_step_s_{0.0};
};

}  // namespace waymark

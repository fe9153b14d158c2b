// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/odometry_check.hpp"

#include <algorithm>

namespace waymark {

Motion OdometryCheck::plausible(const Motion& step, double step_s, bool has_caught_up) {
  is_refused_ = !has_caught_up && !limits_.allow(step, step_s);
  if (!is_refused_) return step;
  refused_step_ = step.start_from_end;
  const double share = last_step_s_ > 0.0 ? std::min(1.0, step_s / last_step_s_) : 0.0;
  const Se2 guess{share * last_step_.x(), share * last_step_.y(), share * last_step_.theta()};
  Motion motion = Motion::between({}, guess);
  motion.guessed_s = step_s;
  return motion;
}

void OdometryCheck::note_estimated(const Se2& start_from_end, double step_s) {
  last_step_ = start_from_end;
  last_step_s_ = step_s;
}

std::vector<Se2> OdometryCheck::steps_without_odometry() const {
  std::vector<Se2> steps{Se2{}, last_step_};
  if (is_refused_) steps.push_back(refused_step_);
  return steps;
}

}  // namespace waymark

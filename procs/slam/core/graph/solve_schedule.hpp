// SPDX-License-Identifier: BSD-3-Clause
// When the whole graph is solved.
#pragma once

#include <algorithm>
#include <cstddef>

namespace waymark {

/// After loop closures the whole graph is solved, one Gauss-Newton step at each keyframe. A
/// solution begins once the graph has grown by a certain share since the last one, so that the cost
/// per keyframe is bounded.
class SolveSchedule {
 public:
  /// @param contradicts_pose  the loop does more than confirm the estimated pose.
  void note_loop(bool contradicts_pose) {
    has_new_loops_ = true;
    loops_matter_ |= contradicts_pose;
  }

  /// Begins a solution at once, for information that moves the whole graph.
  void begin(std::size_t num_keyframes) {
    steps_left_ = kSteps;
    solved_keyframes_ = num_keyframes;
    has_new_loops_ = false;
    loops_matter_ = false;
  }

  /// At a new keyframe: begins a solution if loops are waiting for one. @return whether a step is
  /// due.
  bool advance(std::size_t num_keyframes) {
    const std::size_t share = num_keyframes / (loops_matter_ ? kShare : kRoutineShare);
    if (has_new_loops_ && num_since_solution(num_keyframes) >= std::max(kEvery, share))
      begin(num_keyframes);
    return steps_left_ > 0;
  }

  /// @param moved  largest step of any pose outside the window [m, rad].
  void note_step(double moved) {
    steps_left_ = moved < kConverged ? 0 : std::max(0, steps_left_ - 1);
  }

  std::size_t num_since_solution(std::size_t num_keyframes) const {
    return num_keyframes - solved_keyframes_;
  }

  static constexpr int kSteps = 12;  ///< largest number of steps of a solution

 private:
  // Growth of the graph since the last solution, after which loops begin another one:
  static constexpr std::size_t kEvery = 10;        ///< keyframes, at least
  static constexpr std::size_t kShare = 200;       ///< 1/200, if a loop contradicts the pose
  static constexpr std::size_t kRoutineShare = 8;  ///< 1/8, if loops only confirm the pose
  static constexpr double kConverged = 5e-3;       ///< [m, rad]; less is not worth a further step

  std::size_t solved_keyframes_{0};  ///< size of the graph when the last solution began
  int steps_left_{0};
  bool has_new_loops_{false};  ///< since the last solution began
  bool loops_matter_{false};   ///< one of them contradicts the pose
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// GMapping's odometry model: Gaussian noise per step, proportional to the step.
#pragma once

#include "common/geometry/se2.hpp"
#include "common/random/random.hpp"

namespace waymark {

class Fields;

/// Standard deviations per unit of motion, under GMapping's own names. They apply to every scan's
/// step, so the spread after a given path depends on the number of scans along it.
struct StepNoise {
  double srr{0.1};
  double srt{0.2};
  double str{0.1};
  double stt{0.2};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// Adds noise to the motion of one step.
Se2 sample_step(const Se2& start_from_end, const StepNoise& noise, Random& random);

}  // namespace waymark

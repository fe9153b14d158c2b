// SPDX-License-Identifier: BSD-3-Clause
// What a log says about the set-up of its robot.
#pragma once

#include "doctor/check.hpp"
#include "doctor/motion/hand_eye.hpp"
#include "doctor/patient.hpp"

namespace waymark {

struct Diagnosis {
  std::vector<Check> checks{};
  RobotConfig robot{};  ///< the description, with what was found in its place
};

/// Every check, in the same order for every log.
Diagnosis diagnose(const Patient& patient);

}  // namespace waymark

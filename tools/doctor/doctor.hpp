// SPDX-License-Identifier: BSD-3-Clause
// All checks of a robot's set-up.
#pragma once

#include "doctor/check.hpp"
#include "doctor/doctor_input.hpp"
#include "doctor/motion/hand_eye.hpp"

namespace waymark {

struct Diagnosis {
  std::vector<Check> checks{};
  RobotConfig robot{};  ///< the description with corrections
};

/// All checks, in the same order for every log.
/// @param progress  called with the share of registered scans.
Diagnosis diagnose(const DoctorInput& input, const ShowProgress& progress = {});

}  // namespace waymark

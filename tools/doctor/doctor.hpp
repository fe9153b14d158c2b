// SPDX-License-Identifier: BSD-3-Clause
// What a log says about the set-up of its robot.
#pragma once

#include "doctor/check.hpp"
#include "doctor/doctor_input.hpp"
#include "doctor/motion/hand_eye.hpp"

namespace waymark {

struct Diagnosis {
  std::vector<Check> checks{};
  RobotConfig robot{};  ///< the description, with what was found in its place
};

/// Every check, in the same order for every log.
/// @param progress  is called with the share of the scans that are registered
Diagnosis diagnose(const DoctorInput& input, const ShowProgress& progress = {});

}  // namespace waymark

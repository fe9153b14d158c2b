// SPDX-License-Identifier: BSD-3-Clause
// The doctor's diagnosis of a synthetic drive.
#pragma once

#include "doctor/doctor.hpp"
#include "import/findings/no_return.hpp"
#include "synthetic_drive.hpp"

#include <algorithm>
#include <string>
#include <vector>

namespace waymark {

inline Diagnosis diagnosis_of(const DriveFaults& faults) {
  DoctorInput input = drive_in_room(faults);
  mark_no_returns(input.log, {std::nullopt, 20.0}, input.report);
  return diagnose(input);
}

inline std::vector<std::string> names_of(const Diagnosis& diagnosis, Verdict verdict) {
  std::vector<std::string> names;
  for (const Check& check : diagnosis.checks) {
    if (check.verdict == verdict) names.push_back(check.name);
  }
  return names;
}

inline const Check& find(const Diagnosis& diagnosis, const std::string& name) {
  return *std::ranges::find(diagnosis.checks, name, &Check::name);
}

}  // namespace waymark

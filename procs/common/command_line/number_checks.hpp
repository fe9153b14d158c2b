// SPDX-License-Identifier: BSD-3-Clause
// What a number on a command line may be. CLI11's own checks print their bounds with 309 digits,
// and let nan through.
#pragma once

#include <cmath>
#include <string>

namespace waymark {

struct NumberCheck {
  bool (*is_good)(double finite){};
  std::string expected{};  ///< what is expected, for the error message: "a number above 0"
  std::string name{};      ///< shown in --help as the kind of value: "POSITIVE"
};

inline NumberCheck positive_number() {
  return {[](double number) { return number > 0.0; }, "a number above 0", "POSITIVE"};
}

inline NumberCheck nonnegative_number() {
  return {[](double number) { return number >= 0.0; }, "0 or a number above it", "NONNEGATIVE"};
}

inline NumberCheck finite_number() {
  return {[](double) { return true; }, "a finite number", "NUMBER"};
}

/// A direction [deg], at most one turn.
inline NumberCheck angle_deg() {
  return {[](double number) { return std::abs(number) <= 360.0; },
          "an angle from -360 to 360 degrees", "DEGREES"};
}

}  // namespace waymark

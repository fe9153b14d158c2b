// SPDX-License-Identifier: BSD-3-Clause
// What a number on a command line may be. CLI11's own checks print their bounds with 309 digits,
// and let nan through.
#pragma once

#include <CLI/CLI.hpp>

#include <cmath>
#include <cstdlib>
#include <string>

namespace waymark {

inline CLI::Validator number_that(bool (*is_good)(double), const std::string& expected,
                                  const std::string& shown_in_help) {
  return {[=](const std::string& text) -> std::string {
            const double number = std::strtod(text.c_str(), nullptr);
            if (std::isfinite(number) && is_good(number)) return {};
            return "got " + text + ", expected " + expected;
          },
          shown_in_help};
}

inline CLI::Validator positive_number() {
  return number_that([](double number) { return number > 0.0; }, "a number above 0", "POSITIVE");
}

inline CLI::Validator nonnegative_number() {
  return number_that([](double number) { return number >= 0.0; }, "0 or a number above it",
                     "NONNEGATIVE");
}

inline CLI::Validator finite_number() {
  return number_that([](double) { return true; }, "a finite number", "NUMBER");
}

/// Beyond a turn it is no direction.
inline CLI::Validator angle_deg() {
  return number_that([](double number) { return std::abs(number) <= 360.0; },
                     "an angle from -360 to 360 degrees", "DEGREES");
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// What slam says about its sensors, in words and numbers.
#pragma once

#include "slam/core/filter/findings.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace waymark {

/// One thing that is not as it is described, or was not used.
struct Finding {
  std::string name{};             ///< for programs: a key in findings.json, a counter
  std::string text{};             ///< half a sentence for people
  double value{0.0};              ///< what was found, in the unit that the name says
  std::optional<double> share{};  ///< of the observations or scans that it concerns
};

/// What is worth saying; empty when all is as described.
/// @param repeated_scans  that the sensor queue has left out.
std::vector<Finding> worth_saying(const Findings& findings, std::int64_t repeated_scans);

/// The texts, separated by semicolons; "nothing" without any.
std::string sentence_of(std::span<const Finding> findings);

}  // namespace waymark

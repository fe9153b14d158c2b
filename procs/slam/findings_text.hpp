// SPDX-License-Identifier: BSD-3-Clause
// Findings about the sensors as texts and numbers.
#pragma once

#include "slam/core/estimators/sensor_statistics.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace waymark {

/// One property that differs from its description, or one kind of data that was not used.
struct Finding {
  std::string name{};             ///< for programs: a key in findings.json, a counter
  std::string text{};             ///< a clause for people
  double value{0.0};              ///< in the unit of the name's suffix; else a count or ratio
  std::optional<double> share{};  ///< affected observations or scans / all of them
};

/// The findings that are worth reporting; empty if all is as described.
/// @param repeated_scans  number of repeated scans that the sensor queue has left out.
std::vector<Finding> reportable_findings(const SensorStatistics& statistics,
                                         std::int64_t repeated_scans);

/// The texts, separated by semicolons; "nothing" without any.
std::string sentence_of(std::span<const Finding> findings);

}  // namespace waymark

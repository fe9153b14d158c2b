// SPDX-License-Identifier: BSD-3-Clause
// A replay's cost and counters as JSON, for scripts.
#pragma once

#include "common/node/counters.hpp"

#include <algorithm>
#include <cstdint>
#include <string>

namespace waymark {

struct ReplayReport {
  std::int64_t messages{};
  double log_s{};   ///< log time from --skip-s to the last replayed message
  double wall_s{};  ///< wall-clock time of the replay
  double peak_memory_mb{};

  double real_time_factor() const { return log_s / std::max(wall_s, 1e-9); }
};

/// One JSON object: the members of the report, real_time_factor, and "counters", a list of {"name",
/// "kind", "value"} in order of name, without those that are zero.
std::string to_json(const ReplayReport& report, const Counters& counters);

}  // namespace waymark

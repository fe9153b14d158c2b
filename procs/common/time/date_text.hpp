// SPDX-License-Identifier: BSD-3-Clause
// Message times as text.
#pragma once

#include "common/time/time.hpp"

#include <fmt/chrono.h>
#include <fmt/format.h>

#include <string>

namespace waymark {

/// "2001-09-09 01:53:48.000 UTC (1000000428.000 s)"; of a clock that does not count from 1970:
/// "428.000 s".
inline std::string date_text(Timestamp time) {
  constexpr double kEarliestDate_s = 1e8;  // 1973
  constexpr double kLatestDate_s = 4e9;    // 2096
  const double seconds = to_seconds(time);
  if (!(seconds >= kEarliestDate_s && seconds <= kLatestDate_s))
    return fmt::format("{:.3f} s", seconds);
  const std::int64_t ms = to_us(time) / 1000;
  return fmt::format("{:%Y-%m-%d %H:%M:%S}.{:03} UTC ({:.3f} s)",
                     fmt::gmtime(static_cast<std::time_t>(ms / 1000)), ms % 1000, seconds);
}

}  // namespace waymark

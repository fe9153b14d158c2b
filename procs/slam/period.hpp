// SPDX-License-Identifier: BSD-3-Clause
// Schedules work once per period of message time.
#pragma once

#include "common/time/time.hpp"

#include <optional>

namespace waymark {

class Period {
 public:
  enum class First { kAtOnce, kAfterAPeriod };

  Period(double period_s, First first) : period_{duration_from_seconds(period_s)}, first_{first} {}

  /// Whether the work is due. If so, the next period begins. Restarts when `time` is before the
  /// time at which work was last due.
  bool is_due(Timestamp time) {
    const bool is_new = !next_ || time < *next_ - period_;
    if (!is_new && time < *next_) return false;
    next_ = time + period_;
    return !is_new || first_ == First::kAtOnce;
  }

  void reset() { next_.reset(); }

 private:
  Duration period_;
  First first_;
  std::optional<Timestamp> next_{};
};

}  // namespace waymark

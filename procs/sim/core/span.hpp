// SPDX-License-Identifier: BSD-3-Clause
// Intervals and instants of a run, by time, by distance driven, or both.
#pragma once

#include "common/config/config.hpp"

namespace waymark {

/// Progress of the run.
struct Moment {
  double time_s{0.0};
  double route_m{0.0};  ///< progress along the route; 0 when commands drive
};

/// Later than the end of any run; finite, so that it can be written in TOML.
constexpr double kNever = 1e9;

/// Active while both time and distance driven are within bounds; by default always.
struct Span {
  double from_s{0.0};
  double to_s{kNever};
  double from_m{0.0};
  double to_m{kNever};

  bool covers(const Moment& moment) const {
    return moment.time_s >= from_s && moment.time_s < to_s && moment.route_m >= from_m &&
           moment.route_m < to_m;
  }

  bool is_always() const {
    return from_s <= 0.0 && to_s >= kNever && from_m <= 0.0 && to_m >= kNever;
  }

  bool is_empty() const { return from_s >= to_s || from_m >= to_m; }

  void describe(Fields& fields);
};

/// Happens once, when both time and distance are reached.
struct Trigger {
  double at_s{0.0};
  double at_m{0.0};

  bool is_reached(const Moment& moment) const {
    return moment.time_s >= at_s && moment.route_m >= at_m;
  }

  /// False when it would already be reached at the start of the run.
  bool is_set() const { return at_s > 0.0 || at_m > 0.0; }

  void describe(Fields& fields);
};

}  // namespace waymark

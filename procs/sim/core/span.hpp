// SPDX-License-Identifier: BSD-3-Clause
// Intervals and instants of a run, by time, by progress along the route, or both.
#pragma once

#include "common/config/config.hpp"

namespace waymark {

/// Time since the start of the run, and progress along the route.
struct Moment {
  double time_s{0.0};
  double route_m{0.0};  ///< length of the route driven so far; 0 with route.source = command
};

/// Later than the end of any run; finite, so that it can be written in TOML.
constexpr double kNever = 1e9;

/// Active while time and route_m are both within [from, to); by default always.
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

/// Happens once, as soon as both at_s and at_m are reached.
struct Trigger {
  double at_s{0.0};
  double at_m{0.0};

  bool is_reached(const Moment& moment) const {
    return moment.time_s >= at_s && moment.route_m >= at_m;
  }

  /// False when neither at_s nor at_m is set: the event would happen at the start of the run.
  bool is_set() const { return at_s > 0.0 || at_m > 0.0; }

  void describe(Fields& fields);
};

}  // namespace waymark

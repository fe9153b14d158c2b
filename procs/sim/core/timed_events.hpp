// SPDX-License-Identifier: BSD-3-Clause
// The events of a scenario: faults, boxes, kidnaps, moves of markers.
#pragma once

#include "sim/core/scenario.hpp"

#include <string>
#include <vector>

namespace waymark {

struct TimedEvent {
  std::string key{};  ///< its place in the scenario, e.g. "faults[0]"
  Span during{};      ///< for a kidnap or a move: from its instant on
};

std::vector<TimedEvent> timed_events(const Scenario& scenario);

/// The events of a run that have not begun.
class PendingEvents {
 public:
  explicit PendingEvents(const Scenario& scenario) : pending_{timed_events(scenario)} {}

  /// Call at every physics step.
  void update(const Moment& moment);

  const std::vector<TimedEvent>& events() const { return pending_; }

 private:
  std::vector<TimedEvent> pending_;
};

}  // namespace waymark

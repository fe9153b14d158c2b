// SPDX-License-Identifier: BSD-3-Clause
// What a scenario times: faults, boxes, kidnaps, moves of markers.
#pragma once

#include "sim/core/scenario.hpp"

#include <string>
#include <vector>

namespace waymark {

struct TimedEvent {
  std::string key{};  ///< in the scenario, e.g. "faults[0]"
  Span during{};      ///< of a kidnap or a move: from its instant on
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

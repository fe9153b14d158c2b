// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/timed_events.hpp"

#include <fmt/format.h>

namespace waymark {
namespace {

Span from(const Trigger& trigger) {
  return {.from_s = trigger.at_s, .from_m = trigger.at_m};
}

}  // namespace

std::vector<TimedEvent> timed_events(const Scenario& scenario) {
  std::vector<TimedEvent> events;
  const auto add = [&events](const char* list, std::size_t index, const Span& during) {
    events.push_back({fmt::format("{}[{}]", list, index), during});
  };
  for (std::size_t i = 0; i < scenario.faults.size(); ++i)
    add("faults", i, scenario.faults[i].during);
  for (std::size_t i = 0; i < scenario.world.boxes.size(); ++i)
    add("world.boxes", i, scenario.world.boxes[i].present);
  for (std::size_t i = 0; i < scenario.kidnaps.size(); ++i)
    add("kidnaps", i, from(scenario.kidnaps[i].when));
  for (std::size_t i = 0; i < scenario.markers.moved.size(); ++i)
    add("markers.moved", i, from(scenario.markers.moved[i].when));
  return events;
}

void PendingEvents::update(const Moment& moment) {
  std::erase_if(pending_,
                [&moment](const TimedEvent& event) { return event.during.covers(moment); });
}

}  // namespace waymark

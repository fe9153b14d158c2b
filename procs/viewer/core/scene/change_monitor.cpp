// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/change_monitor.hpp"

#include "common/geometry/rounded.hpp"

#include <fmt/format.h>

namespace waymark::viewer {
namespace {

std::string place(const Eigen::Vector2d& position_m) {
  return fmt::format("({:.2f}, {:.2f}) m", rounded(position_m.x(), 100.0),
                     rounded(position_m.y(), 100.0));
}

std::string name_of(const std::pair<int, int>& id_and_instance) {
  const auto [id, instance] = id_and_instance;
  return instance == 0 ? fmt::format("marker {}", id) : fmt::format("marker {}.{}", id, instance);
}

}  // namespace

ChangeMonitor::Phase ChangeMonitor::phase_of(Health health) {
  switch (health) {
    case Health::kInitialising:
      return Phase::kInitialising;
    case Health::kTracking:
    case Health::kDegenerate:
      return Phase::kLocalised;
    case Health::kLost:
      return Phase::kLost;
    case Health::kUnknown:
      break;
  }
  return Phase::kUnknown;
}

std::optional<Change> ChangeMonitor::update(const EstimatedPose& estimate) {
  const Phase before = std::exchange(phase_, phase_of(estimate.health));
  if (phase_ == before) return std::nullopt;
  const double time_s = to_seconds(estimate.time);
  const std::string where = place(estimate.map_from_base.translation());
  switch (phase_) {
    case Phase::kLost:
      lost_since_ = estimate.time;
      return Change{Change::Kind::kAlarm, fmt::format("{:.1f} s: lost at {}", time_s, where)};
    case Phase::kLocalised:
      if (before == Phase::kLost) {
        return Change{Change::Kind::kNote,
                      fmt::format("{:.1f} s: re-localised at {} after {:.1f} s", time_s, where,
                                  to_seconds(estimate.time - lost_since_))};
      }
      return Change{Change::Kind::kNote, fmt::format("{:.1f} s: localised at {}", time_s, where)};
    case Phase::kInitialising:
      return Change{Change::Kind::kNote,
                    fmt::format("{:.1f} s: initialising at {}", time_s, where)};
    case Phase::kUnknown:
      break;
  }
  return Change{Change::Kind::kNote, fmt::format("{:.1f} s: health unknown at {}", time_s, where)};
}

std::vector<Change> ChangeMonitor::update(Timestamp time, const std::vector<Landmark>& landmarks) {
  std::map<std::pair<int, int>, Sighting> now;
  for (const Landmark& landmark : landmarks)
    now[{landmark.id, landmark.instance}] = {landmark.state,
                                             landmark.map_from_marker.translation()};
  std::vector<Change> changes;
  const auto add = [&](Change::Kind kind, const std::string& what) {
    changes.push_back({kind, fmt::format("{:.1f} s: {}", to_seconds(time), what)});
  };
  for (const auto& [key, sighting] : now) {
    const auto before = known_.find(key);
    const bool is_new = before == known_.end();
    if (!is_new && before->second.state == sighting.state) continue;
    const bool has_moved = sighting.state == LandmarkState::kMoved;
    add(has_moved ? Change::Kind::kAlarm : Change::Kind::kNote,
        fmt::format("{} at {} is {}{}", name_of(key), place(sighting.position_m),
                    is_new ? "new and " : "", name_of(sighting.state)));
  }
  for (const auto& [key, sighting] : known_) {
    if (now.contains(key)) continue;
    add(Change::Kind::kNote,
        fmt::format("{}, last at {}, is gone", name_of(key), place(sighting.position_m)));
  }
  known_ = std::move(now);
  return changes;
}

}  // namespace waymark::viewer

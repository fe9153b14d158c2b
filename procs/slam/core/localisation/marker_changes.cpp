// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/marker_changes.hpp"

namespace waymark {
namespace {

constexpr double kBeforeMarker_m = 0.3;  // in front of a new marker, where the map must be mapped

}  // namespace

std::vector<MapChange> marker_changes(const MapSnapshot& map, const MarkerBook& book,
                                      const State& state) {
  std::vector<MapChange> changes;
  for (std::size_t i = 0; i < book.entries().size(); ++i) {
    const Landmark& marker = book.entries()[i];
    if (book.is_retired(i) || !marker.is_confirmed()) continue;
    MapChange change;
    change.id = marker.id;
    change.instance = marker.instance;
    change.place = state.landmarks[i];
    change.was_at = change.place.translation();
    change.support = marker.sightings;
    if (const auto before = book.moved_from(i)) {
      change.kind = MapChange::Kind::kMarkerMoved;
      change.was_at = state.landmarks[*before].translation();
    } else if (i >= map.landmarks.size()) {
      // A marker in an unmapped place is no contradiction.
      const Eigen::Vector2d before_it = change.place * Eigen::Vector2d{kBeforeMarker_m, 0.0};
      if (!map.grid.occupancy[map.grid.frame.cell_of(before_it)].is_mapped()) continue;
      change.kind = MapChange::Kind::kMarkerNew;
    } else if (marker.is_missed()) {
      change.kind = MapChange::Kind::kMarkerMissing;
      change.support = marker.misses;
    } else {
      continue;
    }
    changes.push_back(change);
  }
  return changes;
}

}  // namespace waymark

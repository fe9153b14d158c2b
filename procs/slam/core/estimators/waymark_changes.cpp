// SPDX-License-Identifier: BSD-3-Clause
// What the graph estimator has found to be otherwise than the loaded map, or the survey, says.
#include "slam/core/estimators/waymark.hpp"

namespace waymark {
namespace {

constexpr int kSurveySteps = 12;
constexpr double kBeforeMarker_m = 0.3;  // free space that the map has there

}  // namespace

/// A surveyed marker that has become sure pulls the whole graph.
void WaymarkEstimator::use_survey() {
  if (survey_.is_empty() || !survey_.match(graph_, book_)) return;
  if (const auto survey_from_map = survey_.new_frame(graph_)) {
    graph_.move_to_frame(*survey_from_map);
    map_.redraw(poses_of(graph_));
    relocalisation_ = {};
    loop_finder_.forget_candidate();
    forget_way_here();
  }
  if (!survey_.has_frame()) return;
  survey_.apply(graph_, kSurveySteps);
  graph_.optimise();
  map_.begin_to_follow();
  note_reason(EstimateReason::kSurvey);
}

std::vector<MapChange> WaymarkEstimator::changes() const {
  std::vector<MapChange> changes;
  const std::size_t num_loaded = setup_.loaded_map ? setup_.loaded_map->landmarks.size() : 0;
  for (std::size_t i = 0; setup_.loaded_map && i < book_.entries().size(); ++i) {
    const Landmark& marker = book_.entries()[i];
    if (book_.is_retired(i) || !marker.is_confirmed()) continue;
    MapChange change;
    change.id = marker.id;
    change.instance = marker.instance;
    change.place = graph_.state().landmarks[i];
    change.was_at = change.place.translation();
    change.support = marker.sightings;
    if (const auto before = book_.moved_from(i)) {
      change.kind = MapChange::Kind::kMarkerMoved;
      change.was_at = graph_.state().landmarks[*before].translation();
    } else if (i >= num_loaded) {
      // Where the map has not been, everything is new.
      const Eigen::Vector2d before_it = change.place * Eigen::Vector2d{kBeforeMarker_m, 0.0};
      const GridMap& loaded = setup_.loaded_map->grid;
      if (!loaded.occupancy[loaded.frame.cell_of(before_it)].is_mapped()) continue;
      change.kind = MapChange::Kind::kMarkerNew;
    } else if (marker.is_missed()) {
      change.kind = MapChange::Kind::kMarkerMissing;
      change.support = marker.misses;
    } else {
      continue;
    }
    changes.push_back(change);
  }
  for (const Survey::Contradiction& off : survey_.contradictions(graph_)) {
    MapChange change;
    change.kind = MapChange::Kind::kSurveyOff;
    change.id = off.marker.id;
    change.place = off.map_from_marker;
    change.was_at = off.marker.survey_from_marker.translation();
    change.sigmas = off.sigmas;
    changes.push_back(change);
  }
  if (wall_changes_)
    for (const MapChange& change : wall_changes_->changes())
      changes.push_back(change);
  return changes;
}

}  // namespace waymark

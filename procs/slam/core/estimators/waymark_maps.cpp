// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses a loaded map or a survey, and creates a map to be saved.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/localisation/marker_changes.hpp"

#include <optional>

namespace waymark {
namespace {

constexpr int kSurveySteps = 12;

}  // namespace

void WaymarkEstimator::load(const std::shared_ptr<const MapSnapshot>& map) {
  loaded_map_.emplace(map);
  for (const Landmark& landmark : map->landmarks) {
    graph_.add_fixed_landmark(landmark.map_from_marker, landmark.covariance);
    book_.add_known(landmark);
  }
  if (start_.kind == StartKind::kAnywhere) place_finder_.emplace(map, config_.scan);
}

/// A surveyed marker with enough sightings becomes a prior, which is tested again after many more
/// sightings. After a new frame or a switched prior the whole graph is solved at once; otherwise
/// only the window, and the other poses follow with the next steps of the whole graph.
void WaymarkEstimator::use_survey() {
  if (survey_.is_empty() || !survey_.match(graph_, book_)) return;
  const auto survey_from_map = survey_.new_frame(graph_);
  if (survey_from_map) {
    graph_.move_to_frame(*survey_from_map);
    drift_.move_to_frame(*survey_from_map);
    unmatched_drift_.move_to_frame(*survey_from_map);
    map_.redraw_all(poses_of(graph_));
    loop_finder_.reset();
    note_pose_given();
  }
  if (!survey_.has_map_frame()) return;
  if (survey_.apply(graph_) || survey_from_map) graph_.optimise_all(kSurveySteps);
  graph_.optimise();
  solve_schedule_.begin(graph_.state().keyframes.size());
  map_.note_poses_changed();
  note_reason(EstimateReason::kSurvey);
}

std::vector<MapChange> WaymarkEstimator::changes() const {
  std::vector<MapChange> all;
  const auto add = [&all](const std::vector<MapChange>& changes) {
    all.insert(all.end(), changes.begin(), changes.end());
  };
  if (loaded_map_) add(marker_changes(loaded_map_->snapshot(), book_, graph_.state()));
  add(survey_.changes(graph_));
  if (loaded_map_) add(loaded_map_->wall_changes());
  return all;
}

std::optional<PoseGraph> WaymarkEstimator::pose_graph() const {
  if (is_map_fixed() || graph_.state().keyframes.empty()) return std::nullopt;
  return pose_graph_of(solved());
}

/// None before the pose in the loaded map was confirmed, or if most contradicts that map: the new
/// map might mix two buildings. None before
/// the survey's frame is known: the map would be in another frame.
std::optional<MapSnapshot> WaymarkEstimator::snapshot() const {
  if (is_map_fixed() || graph_.state().keyframes.empty() || !has_map_frame()) return std::nullopt;
  if (loaded_map_ && (!loaded_map_->was_confirmed() || loaded_map_->is_of_another_building()))
    return std::nullopt;
  const Graph& graph = solved();
  MapSnapshot snapshot;
  if (loaded_map_) snapshot.parent_map_id = loaded_map_->snapshot().map_id;
  snapshot.time = newest_time_;
  snapshot.walls =
      loaded_map_ ? loaded_map_->snapshot().walls : NdtMap{config_.scan.cell_spacing_m};
  for (std::size_t i = 0; i < map_.scans().size(); ++i) {
    const Se2& map_from_base = graph.state().keyframes[i];
    for (const AnnotatedBeam& annotated : map_.scans().at(i).beams)
      snapshot.walls.add(map_from_base * annotated.beam.end_in_base, kNoKeyframe);
  }
  snapshot.grid = map_.drawn_along(poses_of(graph));
  snapshot.walls =
      walls_to_save(snapshot.walls, snapshot.grid, registration_.range_noise().variance_m2());
  for (Landmark landmark : landmarks_of(graph))
    if (!landmark.is_missed()) snapshot.landmarks.push_back(landmark);
  snapshot.graph = pose_graph_of(graph);
  if (loaded_map_) add_unvisited(loaded_map_->snapshot().graph, snapshot.graph);
  snapshot.calibration.mean = graph.state().calibration;
  snapshot.calibration.covariance = graph.covariance({}, {});
  return snapshot;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses a loaded map or a survey, and creates a map to be saved.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/graph/map_fit.hpp"
#include "slam/core/graph/marker_changes.hpp"
#include "slam/core/grid/occupied_points.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <optional>

namespace waymark {
namespace {

constexpr int kSurveySteps = 12;
constexpr double kMinMapped = 0.6;           // share of mapped beams, for a scan to be in the map
constexpr std::int64_t kScansToDecide = 10;  // before the loaded map can be refuted
constexpr std::int64_t kScansKept = 20;  // about so many vote: earlier ones may have looked alike

}  // namespace

void WaymarkEstimator::load(const MapSnapshot& map) {
  for (const Landmark& landmark : map.landmarks) {
    graph_.add_fixed_landmark(landmark.map_from_marker, landmark.covariance);
    book_.add_known(landmark);
  }
  loaded_points_ = occupied_points(map.grid);
  for (const Eigen::Vector2d& point : loaded_points_)
    loaded_coarse_.add(point);
  wall_changes_.emplace(setup_.loaded_map);
  place_trust_ = PlaceTrust::kAssumed;
  was_confirmed_ = false;
  if (start_.kind == StartKind::kAnywhere) place_finder_.emplace(setup_.loaded_map, config_.scan);
}

const NdtMap& WaymarkEstimator::ndt_of(const MatchedScan& scan) const {
  return scan.submap != nullptr ? scan.submap->ndt() : setup_.loaded_map->walls;
}

Points WaymarkEstimator::points_near(const MatchedScan& scan, const Se2& submap_from_base,
                                     double within_m) const {
  if (scan.submap != nullptr) return scan.submap->points();
  Points near;
  for (const Eigen::Vector2d& point : loaded_points_)
    if ((point - submap_from_base.translation()).norm() < within_m) near.push_back(point);
  return near;
}

bool WaymarkEstimator::is_in_loaded_map(const ScanMatch& match) const {
  return match.is_usable(config_.scan) && !usual_fit_.is_refuted(match) &&
         match.mapped_share >= kMinMapped;
}

/// Compares the newest keyframe's scan, at its estimated pose, with the loaded map. A match that
/// observes every direction confirms the pose, unless too many beams cross the map's walls: at a
/// wrong heading, the walls that are in the map may fit all the same.
void WaymarkEstimator::compare_with_loaded_map(const Observation& observation,
                                               const KeyframeScan& used) {
  if (!setup_.loaded_map) return;
  const MapFit fit =
      fit_in_map(setup_.loaded_map->grid, observation.beams, graph_.state().keyframes.back());
  if (used.fits_loaded_map && !is_confirmed() && !fit.is_refuted())
    place_trust_ = PlaceTrust::kFitsWalls;
  LoadedMapFit& all = statistics_.loaded_map;
  const MarkerBook::KnownMarkers markers = book_.known_markers();
  all.markers_in_place = markers.in_place;
  all.markers_moved = markers.moved;
  if (!fit.is_decisive()) return;
  if (loaded_map_votes_.decisive >= kScansKept) {
    loaded_map_votes_.decisive /= 2;
    loaded_map_votes_.contradicting /= 2;
  }
  ++all.scans;
  ++loaded_map_votes_.decisive;
  if (fit.is_contradicted()) ++all.contradicting;
  if (!fit.is_refuted()) return;
  ++all.refuting;
  ++loaded_map_votes_.contradicting;
}

/// Whether most of what was seen contradicts the loaded map, although some of its markers are where
/// it has them: another building may have the same ids, at some of the same places.
bool WaymarkEstimator::is_of_another_building() const {
  return statistics_.loaded_map.do_markers_contradict() ||
         statistics_.loaded_map.do_walls_contradict();
}

/// Whether most scans contradict the pose in the loaded map, and it is not known otherwise.
bool WaymarkEstimator::is_loaded_map_refuted() const {
  return place_trust_ != PlaceTrust::kKnown && loaded_map_votes_.decisive >= kScansToDecide &&
         2 * loaded_map_votes_.contradicting > loaded_map_votes_.decisive;
}

/// The loaded map is fixed: a match with it is a prior on the pose.
void WaymarkEstimator::add_map_factor(std::size_t keyframe, const ScanMatch& match) {
  graph_.add(PosePrior{keyframe, match.map_from_base, root_of(match.observed.information)});
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
  if (setup_.loaded_map) add(marker_changes(*setup_.loaded_map, book_, graph_.state()));
  add(survey_.changes(graph_));
  if (wall_changes_) add(wall_changes_->changes());
  return all;
}

std::optional<PoseGraph> WaymarkEstimator::pose_graph() const {
  if (is_map_fixed() || graph_.state().keyframes.empty()) return std::nullopt;
  return pose_graph_of(solved());
}

/// None before the pose in the loaded map was confirmed, or if most contradicts that map: the new
/// map might mix two buildings. None
/// before the survey's frame is known: the map would be in another frame.
std::optional<MapSnapshot> WaymarkEstimator::snapshot() const {
  if (is_map_fixed() || graph_.state().keyframes.empty() || !was_confirmed_ ||
      is_of_another_building() || !has_map_frame()) {
    return std::nullopt;
  }
  const Graph& graph = solved();
  MapSnapshot snapshot;
  if (setup_.loaded_map) snapshot.parent_map_id = setup_.loaded_map->map_id;
  snapshot.time = newest_time_;
  snapshot.walls =
      setup_.loaded_map ? setup_.loaded_map->walls : NdtMap{config_.scan.cell_spacing_m};
  for (std::size_t i = 0; i < map_.scans().size(); ++i) {
    const Se2& map_from_base = graph.state().keyframes[i];
    for (const AnnotatedBeam& annotated : map_.scans().at(i).beams)
      snapshot.walls.add(map_from_base * annotated.beam.end_in_base, 0);
  }
  snapshot.grid = map_.drawn_along(poses_of(graph));
  snapshot.walls = walls_to_save(snapshot.walls, snapshot.grid, range_noise_.variance_m2());
  for (Landmark landmark : landmarks_of(graph))
    if (!landmark.is_missed()) snapshot.landmarks.push_back(landmark);
  snapshot.graph = pose_graph_of(graph);
  if (setup_.loaded_map) add_unvisited(setup_.loaded_map->graph, snapshot.graph);
  snapshot.calibration.mean = graph.state().calibration;
  snapshot.calibration.covariance = graph.covariance({}, {});
  return snapshot;
}

}  // namespace waymark

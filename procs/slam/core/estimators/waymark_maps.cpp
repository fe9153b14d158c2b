// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses a loaded map, and makes one to be saved.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/grid/occupied_points.hpp"
#include "slam/core/mapping/seen_through.hpp"

#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace waymark {
namespace {

constexpr double kLeastMapped = 0.6;   // share of the beams on walls of the loaded map, to be in it
constexpr double kMostPoints = 400.0;  // of a wall's cell: newer ones outweigh older ones in time

/// What the loaded map was drawn along, where the robot has not been since: bounded by the area.
void add_loaded_graph(const PoseGraph& loaded, PoseGraph& graph) {
  constexpr double kThereAlready_m = 0.5;
  const auto place_of = [](const Se2& pose) {
    return std::pair{std::lround(pose.x() / kThereAlready_m),
                     std::lround(pose.y() / kThereAlready_m)};
  };
  std::set<std::pair<long, long>> today;  // and the places around it
  for (const Se2& pose : graph.poses) {
    const auto [x, y] = place_of(pose);
    for (long i = x - 1; i <= x + 1; ++i)
      for (long k = y - 1; k <= y + 1; ++k)
        today.emplace(i, k);
  }
  std::vector<std::optional<std::size_t>> kept_as(loaded.poses.size());
  for (std::size_t i = 0; i < loaded.poses.size(); ++i) {
    if (today.contains(place_of(loaded.poses[i]))) continue;
    kept_as[i] = graph.poses.size();
    graph.poses.push_back(loaded.poses[i]);
  }
  for (GraphEdge edge : loaded.edges) {
    if (!kept_as[edge.from] || !kept_as[edge.to]) continue;
    edge.from = *kept_as[edge.from];
    edge.to = *kept_as[edge.to];
    graph.edges.push_back(edge);
  }
}

GraphEdge edge_of(const ScanFactor& factor) {
  const auto main =
      std::max_element(factor.references.begin(), factor.references.end(),
                       [](const auto& a, const auto& b) { return a.share < b.share; });
  const Eigen::Matrix2d turn = main->reference_from_keyframe.rotation();
  Eigen::Matrix3d in_reference = Eigen::Matrix3d::Identity();
  in_reference.topLeftCorner<2, 2>() = turn;
  const Eigen::Matrix3d root = factor.weight * factor.root_information * in_reference.transpose();
  return {main->keyframe, factor.keyframe, main->reference_from_keyframe, root.transpose() * root};
}

PoseGraph pose_graph_of(const Graph& graph) {
  PoseGraph result;
  std::vector<std::size_t> number;  // of each keyframe in the result
  for (std::size_t i = 0; i < graph.state().keyframes.size(); ++i) {
    number.push_back(result.poses.size());
    if (!graph.is_removed(i)) result.poses.push_back(graph.state().keyframes[i]);
  }
  const OdometryNoise noise = graph.odometry_noise();
  for (const Factor& factor : graph.factors()) {
    if (const auto* odometry = std::get_if<OdometryFactor>(&factor)) {
      if (odometry->is_cut || odometry->motion.distance_m + odometry->motion.turn_rad <= 0.0)
        continue;
      const CorrectedMotion moved =
          corrected_motion(odometry->motion, odometry_part(graph.state().calibration), noise);
      result.edges.push_back(
          {odometry->from, odometry->to, moved.start_from_end, moved.covariance.inverse()});
    } else if (const auto* scan = std::get_if<ScanFactor>(&factor)) {
      if (!scan->references.empty()) result.edges.push_back(edge_of(*scan));
    }
  }
  for (GraphEdge& edge : result.edges) {
    edge.from = number[edge.from];
    edge.to = number[edge.to];
  }
  return result;
}

}  // namespace

void WaymarkEstimator::load(const MapSnapshot& map) {
  for (const Landmark& landmark : map.landmarks) {
    graph_.add_fixed_landmark(landmark.map_from_marker, landmark.covariance);
    book_.add_known(landmark);
  }
  loaded_points_ = occupied_points(map.grid);
  wall_changes_.emplace(setup_.loaded_map);
  is_confirmed_ = false;
  if (start_.kind == StartKind::kAnywhere) place_finder_.emplace(setup_.loaded_map, config_.scan);
}

const NdtMap& WaymarkEstimator::surfaces_of(const MatchedScan& scan) const {
  return scan.submap != nullptr ? scan.submap->surfaces() : setup_.loaded_map->walls;
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
  return match.is_usable(config_.scan) && !is_refuted(match) && match.mapped_share >= kLeastMapped;
}

/// Walls that show every direction confirm a place.
void WaymarkEstimator::confirm_place(const MatchedScan& scan) {
  if (scan.submap == nullptr && !scan.match.observed.is_degenerate && is_in_loaded_map(scan.match))
    is_confirmed_ = true;
}

/// The loaded map does not move.
void WaymarkEstimator::add_map_factor(std::size_t keyframe, const ScanMatch& match) {
  graph_.add(PosePrior{keyframe, match.map_from_base, root_of(match.observed.information)});
}

/// Of the map at a place: that of its nearest marker.
Eigen::Matrix3d WaymarkEstimator::loaded_map_covariance(const Se2& map_from_base) const {
  const Landmark* nearest = nullptr;
  const auto away = [&](const Landmark& landmark) {
    return (landmark.map_from_marker.translation() - map_from_base.translation()).norm();
  };
  for (const Landmark& landmark : setup_.loaded_map->landmarks)
    if (nearest == nullptr || away(landmark) < away(*nearest)) nearest = &landmark;
  return nearest == nullptr ? Eigen::Matrix3d::Zero() : nearest->covariance;
}

std::optional<PoseGraph> WaymarkEstimator::pose_graph() const {
  if (is_frozen() || graph_.state().keyframes.empty()) return std::nullopt;
  return pose_graph_of(solved());
}

std::optional<MapSnapshot> WaymarkEstimator::snapshot() const {
  if (is_frozen() || graph_.state().keyframes.empty()) return std::nullopt;
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
  NdtMap kept{snapshot.walls.spacing_m()};
  for (NdtCellSums cell : snapshot.walls.sums()) {
    const Eigen::Vector2d centre = kept.spacing_m() * Eigen::Vector2d{cell.column, cell.row};
    const NdtSurface* surface = snapshot.walls.at(centre, range_noise_.variance_m2());
    // Between the walls of a corner, where their mean is, it is free.
    const bool has_free_middle = surface != nullptr && !surface->is_line;
    if (has_free_middle ? is_seen_through(snapshot.grid, centre, kept.spacing_m())
                        : is_seen_through(snapshot.grid, centre + cell.sum_m / cell.count)) {
      continue;
    }
    const double share = std::min(1.0, kMostPoints / cell.count);
    cell.count *= share;
    cell.sum_m *= share;
    cell.squares_m2 *= share;
    kept.add(cell);
  }
  snapshot.walls = std::move(kept);
  for (Landmark landmark : landmarks_of(graph))
    if (!landmark.is_missed()) snapshot.landmarks.push_back(landmark);
  snapshot.graph = pose_graph_of(graph);
  if (setup_.loaded_map) add_loaded_graph(setup_.loaded_map->graph, snapshot.graph);
  snapshot.calibration.mean = graph.state().calibration;
  snapshot.calibration.covariance = graph.covariance({}, {});
  return snapshot;
}

}  // namespace waymark

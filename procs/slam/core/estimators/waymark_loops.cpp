// SPDX-License-Identifier: BSD-3-Clause
// Loops, and steps of the whole graph.
#include "common/geometry/information.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <utility>

namespace waymark {
namespace {

// chi^2 (3 degrees of freedom, 99 %) beyond which a loop contradicts the published pose, which is
// wrong until the graph has been solved.
constexpr double kLoopContradicts = 11.3;
constexpr double kLoopSlack_m = 0.05;  // sigma added for old poses, whose covariance is not kept
constexpr double kLoopSlack_rad = 0.01;

/// Covariance of the newest pose relative to an old one, with margins: the smaller of its
/// covariance in the map and the drift since the old one.
Eigen::Matrix3d covariance_against_old(const Eigen::Matrix3d& in_map,
                                       const Eigen::Matrix3d& drifted) {
  Eigen::Matrix3d covariance = kLoopCovarianceMargin * smaller_covariance(drifted, in_map);
  covariance.diagonal() += Eigen::Vector3d{kLoopSlack_m, kLoopSlack_m, kLoopSlack_rad}.cwiseAbs2();
  return covariance;
}

/// Whether a loop contradicts the pose in the directions that its match observes.
/// @param covariance  of the estimated pose, map axes.
bool contradicts(const LoopFinder::Found& found, const Se2& map_from_submap,
                 const Eigen::Matrix3d& covariance) {
  const Eigen::Matrix3d information =
      in_axes(map_from_submap.rotation(), found.loop.match.observed.information);
  return found.innovation.dot(with_more_noise(information, covariance) * found.innovation) >
         kLoopContradicts;
}

}  // namespace

void WaymarkEstimator::close_loops(const Points& points) {
  since_loop_search_m_ += motion_.distance_m;
  if (since_loop_search_m_ >= config_.loops.every_m) {
    LoopSearch search;
    search.driven_m = std::exchange(since_loop_search_m_, 0.0);
    search.map_from_base = graph_.state().keyframes.back();
    const Eigen::Matrix3d in_map = graph_.covariance_of({VariableKind::kKeyframe, newest()});
    search.covariance_against = [this, in_map](std::size_t keyframe) {
      return covariance_against_old(in_map, drift_.since(keyframe));
    };
    search.first_recent_keyframe = graph_.first_active_keyframe();
    search.covariance_since = [this](std::size_t keyframe) {
      return graph_.covariance_since(keyframe);
    };
    for (const LoopFinder::Found& found :
         loop_finder_.find(newest(), points, search, submaps_.finished(), graph_.state(),
                           registration_.range_noise())) {
      const Submap* submap = submaps_.find(found.loop.submap);
      if (submap == nullptr || graph_.is_removed(found.keyframe)) continue;  // forgotten meanwhile
      add_scan_factor(found.keyframe, *submap, found.loop.match, true);
      solve_schedule_.note_loop(
          contradicts(found, graph_.state().keyframes[found.loop.submap], in_map));
      note_reason(EstimateReason::kLoop);
    }
  }
  if (solve_schedule_.advance(graph_.state().keyframes.size())) step_whole_graph({});
}

/// Takes one step of the whole graph; the published map follows it.
void WaymarkEstimator::step_whole_graph(const std::vector<std::size_t>& returning_landmarks) {
  std::vector<std::size_t> activated = returning_landmarks;
  for (std::size_t i = 0; i < book_.entries().size(); ++i) {
    const double away_m =
        (graph_.state().landmarks[i].translation() - graph_.state().keyframes.back().translation())
            .norm();
    if (!book_.is_retired(i) && !graph_.is_fixed(i) && away_m < kNear_m) activated.push_back(i);
  }
  solve_schedule_.note_step(graph_.step_all(activated));
  map_.note_poses_changed();
}

std::function<Se2(std::size_t)> WaymarkEstimator::poses_of(const Graph& graph) {
  return [&graph](std::size_t keyframe) {
    return graph.state().keyframes[keyframe];
  };
}

/// Removes redundant keyframes, so that memory and time grow with the mapped area.
void WaymarkEstimator::remove_redundant_keyframes() {
  const std::vector<RemovedKeyframe> removable = thinning_.removable(graph_);
  if (removable.empty()) return;
  graph_.remove_keyframes(removable);
  submaps_.forget([this](std::size_t keyframe) { return graph_.is_removed(keyframe); });
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// The whole graph: loops, the trajectory, and the map drawn along it.
#include "slam/core/estimators/waymark.hpp"

#include <algorithm>

namespace waymark {
namespace {

constexpr double kLoopMargin = 4.0;  // on the covariance of the pose: it is a model
constexpr int kSolveSteps = 12;
constexpr std::size_t kSolveEvery = 10;  // keyframes; and as the graph grows
constexpr std::size_t kSolveShare = 40;  // a share of all, so that the cost per keyframe is bounded
constexpr std::size_t kRoutineShare = 8;  // the same of loops that only confirm the pose
constexpr double kLoopMatters = 3.0;      // chi^2 of a loop that does more
constexpr double kSettled = 5e-3;         // [m, rad] less is not worth a further step
constexpr double kLoopSlack_m = 0.05;     // of old poses, whose covariance is not known any more
constexpr double kLoopSlack_rad = 0.01;

}  // namespace

void WaymarkEstimator::close_loops(const Points& points) {
  since_loop_search_m_ += motion_.distance_m;
  if (since_loop_search_m_ >= config_.loops.every_m) {
    since_loop_search_m_ = 0.0;
    LoopSearch search;
    search.map_from_base = graph_.state().keyframes.back();
    search.covariance = kLoopMargin * graph_.covariance_of({VariableKind::kKeyframe, newest()});
    search.covariance.diagonal() +=
        Eigen::Vector3d{kLoopSlack_m, kLoopSlack_m, kLoopSlack_rad}.cwiseAbs2();
    search.first_recent_keyframe = graph_.first_active_keyframe();
    for (const LoopFinder::Found& found :
         loop_finder_.find(newest(), points, search, submaps_, graph_.state(), range_noise_)) {
      const auto submap =
          std::find_if(submaps_.begin(), submaps_.end(), [&found](const Submap& candidate) {
            return candidate.first_keyframe() == found.loop.submap;
          });
      if (submap == submaps_.end()) continue;  // forgotten meanwhile
      add_scan_factor(found.keyframe, *submap, found.loop.match, true);
      has_new_loops_ = true;
      note_reason(EstimateReason::kLoop);
      loops_matter_ |= found.chi2 > kLoopMatters;
    }
  }
  const std::size_t all = graph_.state().keyframes.size();
  const std::size_t since = all - solved_keyframes_;
  if (has_new_loops_ &&
      since >= std::max(kSolveEvery, all / (loops_matter_ ? kSolveShare : kRoutineShare))) {
    solve_steps_left_ = kSolveSteps;
    solved_keyframes_ = all;
    has_new_loops_ = false;
    loops_matter_ = false;
  }
  if (solve_steps_left_ > 0) step_everything({});
}

/// The published map follows.
void WaymarkEstimator::step_everything(const std::vector<std::size_t>& returning_landmarks) {
  std::vector<std::size_t> activated = returning_landmarks;
  for (std::size_t i = 0; i < book_.entries().size(); ++i) {
    const double away_m =
        (graph_.state().landmarks[i].translation() - graph_.state().keyframes.back().translation())
            .norm();
    if (!book_.is_retired(i) && !graph_.is_fixed(i) && away_m < kNear_m) activated.push_back(i);
  }
  const double moved = graph_.step_all(activated);
  solve_steps_left_ = moved < kSettled ? 0 : std::max(0, solve_steps_left_ - 1);
  map_.begin_to_follow();
}

std::function<Se2(std::size_t)> WaymarkEstimator::poses_of(const Graph& graph) {
  return [&graph](std::size_t keyframe) {
    return graph.state().keyframes[keyframe];
  };
}

/// Of places that are known well, so that memory and time grow with the area.
void WaymarkEstimator::forget_surplus() {
  const std::vector<RemovedKeyframe> surplus = thinning_.surplus(graph_);
  if (surplus.empty()) return;
  graph_.remove_keyframes(surplus);
  std::erase_if(submaps_, [this](const Submap& submap) {
    for (std::size_t k = submap.first_keyframe(); k <= submap.last_keyframe(); ++k)
      if (graph_.is_removed(k)) return true;
    return false;
  });
}

/// The whole graph, at its optimum; until the next update.
const Graph& WaymarkEstimator::solved() const {
  if (!solved_) {
    solved_.emplace(graph_);
    solved_->optimise_all(kSolveSteps);
  }
  return *solved_;
}

std::vector<TimedPose> WaymarkEstimator::trajectory() const {
  if (is_frozen()) return {};
  const Graph& graph = solved();
  std::vector<TimedPose> trajectory;
  trajectory.reserve(scan_poses_.size());
  for (const ScanPose& scan : scan_poses_)
    trajectory.push_back(
        {scan.time, graph.state().keyframes[scan.keyframe] * scan.keyframe_from_base});
  return trajectory;
}

GridMap WaymarkEstimator::redrawn_map() const {
  if (is_frozen()) return map();
  const Graph& graph = solved();
  return map_.drawn_along(poses_of(graph));
}

}  // namespace waymark

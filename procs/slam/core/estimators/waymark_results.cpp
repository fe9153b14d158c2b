// SPDX-License-Identifier: BSD-3-Clause
// What the graph estimator has found: markers, trajectory and map along the solved graph, and what
// it has learnt about the sensors.
#include "slam/core/estimators/waymark.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace waymark {

/// The whole graph at its optimum; valid until the next update.
const Graph& WaymarkEstimator::solved() const {
  if (!solved_) {
    solved_.emplace(graph_);
    solved_->optimise_all(SolveSchedule::kSteps);
  }
  return *solved_;
}

std::vector<TimedPose> WaymarkEstimator::trajectory() const {
  if (is_map_fixed()) return {};
  return scan_poses_.along(solved().state().keyframes);
}

GridMap WaymarkEstimator::redrawn_map() const {
  if (is_map_fixed()) return map();
  const Graph& graph = solved();
  return map_.drawn_along(poses_of(graph));
}

std::vector<Landmark> WaymarkEstimator::landmarks() const {
  return landmarks_of(graph_);
}

std::vector<Landmark> WaymarkEstimator::landmarks_of(const Graph& graph) const {
  std::vector<Landmark> known;
  for (std::size_t i = 0; i < book_.entries().size(); ++i) {
    if (book_.is_retired(i)) continue;
    known.push_back(book_.entries()[i]);
    known.back().map_from_marker = graph.state().landmarks[i];
    known.back().covariance = graph.landmark_covariance(i);
  }
  std::stable_sort(known.begin(), known.end(), [](const Landmark& a, const Landmark& b) {
    return std::pair{a.id, a.instance} < std::pair{b.id, b.instance};
  });
  return known;
}

std::optional<SensorStatistics> WaymarkEstimator::statistics() const {
  SensorStatistics statistics = statistics_;
  const LearntOdometryNoise& learnt = graph_.noise().learnt_odometry;
  statistics.odometry_along = learnt.along;
  statistics.odometry_turn = learnt.turn;
  statistics.slips = noise_learner_.num_slips();
  statistics.slip_m_per_sqrt_m = std::sqrt(learnt.slip_m2_per_m);
  registration_.report(statistics);
  statistics.described_range_sigma_m = setup_.range_sigma_m;
  if (loaded_map_) statistics.loaded_map = loaded_map_->fit();
  statistics.loops_ambiguous = loop_finder_.num_ambiguous();
  const Calibration variances = graph_.covariance({}, {}).diagonal();
  for (const std::size_t term : graph_.doubted_calibration_terms()) {
    const auto i = static_cast<Eigen::Index>(term);
    statistics.miscalibrated.push_back(
        {term, graph_.state().calibration[i], std::sqrt(variances[i])});
  }
  return statistics;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/pose_graph.hpp"

#include "slam/core/graph/graph.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <optional>
#include <set>
#include <utility>
#include <variant>

namespace waymark {
namespace {

constexpr double kThereAlready_m = 0.5;

GraphEdge edge_of(const ScanFactor& factor) {
  const auto main =
      std::max_element(factor.references.begin(), factor.references.end(),
                       [](const auto& a, const auto& b) { return a.share < b.share; });
  const Eigen::Matrix3d in_reference = block_rotation(main->reference_from_keyframe.rotation());
  const Eigen::Matrix3d root = factor.weight * factor.root_information * in_reference.transpose();
  return {main->keyframe, factor.keyframe, main->reference_from_keyframe, root.transpose() * root};
}

}  // namespace

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
      if (odometry->is_disabled || odometry->motion.distance_m + odometry->motion.turn_rad <= 0.0)
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

void add_unvisited(const PoseGraph& earlier, PoseGraph& graph) {
  const auto place_of = [](const Se2& pose) {
    return std::pair{std::lround(pose.x() / kThereAlready_m),
                     std::lround(pose.y() / kThereAlready_m)};
  };
  std::set<std::pair<long, long>> today;  // places of this run and their neighbours
  for (const Se2& pose : graph.poses) {
    const auto [x, y] = place_of(pose);
    for (long i = x - 1; i <= x + 1; ++i)
      for (long k = y - 1; k <= y + 1; ++k)
        today.emplace(i, k);
  }
  std::vector<std::optional<std::size_t>> kept_as(earlier.poses.size());
  for (std::size_t i = 0; i < earlier.poses.size(); ++i) {
    if (today.contains(place_of(earlier.poses[i]))) continue;
    kept_as[i] = graph.poses.size();
    graph.poses.push_back(earlier.poses[i]);
  }
  for (GraphEdge edge : earlier.edges) {
    if (!kept_as[edge.from] || !kept_as[edge.to]) continue;
    edge.from = *kept_as[edge.from];
    edge.to = *kept_as[edge.to];
    graph.edges.push_back(edge);
  }
}

}  // namespace waymark

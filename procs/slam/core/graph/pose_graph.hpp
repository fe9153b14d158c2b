// SPDX-License-Identifier: BSD-3-Clause
// The poses of a graph and what was measured between them, for files and other tools.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

class Graph;

/// One pose of a graph as it was measured from another.
struct GraphEdge {
  std::size_t from{0};
  std::size_t to{0};
  Se2 from_from_to{};
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};  ///< order x y theta, frame of `from`
};

/// The poses that a map was drawn along, and what ties them.
struct PoseGraph {
  std::vector<Se2> poses{};  ///< map_from_base
  std::vector<GraphEdge> edges{};
};

/// Keyframes with their odometry and scan factors; markers are not in it.
PoseGraph pose_graph_of(const Graph& graph);

/// Adds what an earlier map was drawn along, where the robot has not been since: the sum is bounded
/// by the area.
void add_unvisited(const PoseGraph& earlier, PoseGraph& graph);

}  // namespace waymark

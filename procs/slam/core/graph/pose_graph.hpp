// SPDX-License-Identifier: BSD-3-Clause
// A graph reduced to relative poses, for files and other tools.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

class Graph;

/// One pose measured relative to another.
struct GraphEdge {
  std::size_t from{0};
  std::size_t to{0};
  Se2 from_from_to{};
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};  ///< order x y theta, frame of `from`
};

/// Keyframes of a map, and the constraints between them.
struct PoseGraph {
  std::vector<Se2> poses{};  ///< map_from_base
  std::vector<GraphEdge> edges{};
};

/// Keyframes with their odometry and scan factors, without markers.
PoseGraph pose_graph_of(const Graph& graph);

/// Adds the poses of an earlier map's graph that are near no pose of `graph`, and the edges among
/// them; no edge connects them to the poses of `graph`. So graphs of extended maps grow with the
/// area and not with the number of runs.
void add_unvisited(const PoseGraph& earlier, PoseGraph& graph);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// A graph reduced to relative poses, for files and other tools.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <vector>

namespace waymark {

class Graph;

/// One pose, measured from another one.
struct GraphEdge {
  std::size_t from{0};
  std::size_t to{0};
  Se2 from_from_to{};
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};  ///< order x y theta, frame of `from`
};

/// The poses that a map was drawn along, and the constraints between them.
struct PoseGraph {
  std::vector<Se2> poses{};  ///< map_from_base
  std::vector<GraphEdge> edges{};
};

/// Keyframes with their odometry and scan factors, without markers.
PoseGraph pose_graph_of(const Graph& graph);

/// Adds the part of an earlier map's graph that lies where the robot has not been since, so that
/// graphs of extended maps grow with the area.
void add_unvisited(const PoseGraph& earlier, PoseGraph& graph);

}  // namespace waymark

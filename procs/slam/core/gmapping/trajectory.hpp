// SPDX-License-Identifier: BSD-3-Clause
// Trajectories of the particles as a tree: shared parts are stored once, dead branches are freed.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/scan/beams.hpp"

#include <memory>
#include <vector>

namespace waymark {

using StoredScan = std::vector<Beam>;

/// One processed scan on the trajectory of one particle, or of several that descend from it.
struct TrajectoryNode {
  TrajectoryNode(const Se2& pose, std::shared_ptr<const StoredScan> beams,
                 std::shared_ptr<TrajectoryNode> before)
      : map_from_base{pose}, scan{std::move(beams)}, parent{std::move(before)} {}

  TrajectoryNode(const TrajectoryNode&) = delete;
  TrajectoryNode& operator=(const TrajectoryNode&) = delete;
  ~TrajectoryNode();

  Se2 map_from_base;
  std::shared_ptr<const StoredScan> scan;  ///< the same one for all particles
  std::shared_ptr<TrajectoryNode> parent;  ///< one processed scan earlier; null at the root
};

using Trajectory = std::shared_ptr<TrajectoryNode>;  ///< the newest node

/// The newest node that all trajectories share; null if there is none. The trajectories must have
/// equal lengths. O(particles x nodes that they do not share).
Trajectory common_ancestor(std::vector<Trajectory> trajectories);

/// map_from_base of the nodes that still have their scan, oldest first.
std::vector<Se2> poses_along(const Trajectory& trajectory);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/trajectory.hpp"

#include <algorithm>

namespace waymark {

TrajectoryNode::~TrajectoryNode() {
  // Iteratively: recursion over a chain as long as the run would overflow the stack.
  Trajectory next = std::move(parent);
  while (next && next.use_count() == 1)
    next = std::move(next->parent);
}

Trajectory common_ancestor(std::vector<Trajectory> trajectories) {
  const auto all_the_same = [&] {
    return std::all_of(trajectories.begin(), trajectories.end(),
                       [&](const Trajectory& node) { return node == trajectories.front(); });
  };
  while (!all_the_same()) {
    for (Trajectory& node : trajectories)
      node = node->parent;
  }
  return trajectories.front();
}

std::vector<Se2> poses_along(const Trajectory& trajectory) {
  std::vector<Se2> poses;
  for (const TrajectoryNode* node = trajectory.get(); node && node->scan; node = node->parent.get())
    poses.push_back(node->map_from_base);
  std::reverse(poses.begin(), poses.end());
  return poses;
}

}  // namespace waymark

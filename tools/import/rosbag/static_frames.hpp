// SPDX-License-Identifier: BSD-3-Clause
// How sensors are mounted: the tree of static transforms.
#pragma once

#include "import/rosbag/ros_messages.hpp"

#include <map>
#include <optional>
#include <string>

namespace waymark {

/// Frames, each fixed in its parent.
class StaticFrames {
 public:
  void add(const RosTransform& transform);

  bool empty() const { return parents_.empty(); }

  /// Nothing when the two are not in one tree.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& child) const;

 private:
  struct Link {
    std::string parent{};
    Eigen::Isometry3d parent_from_child{};
  };

  /// The topmost frame above one, and its pose in there.
  Link root_of(const std::string& frame) const;

  std::map<std::string, Link> parents_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How sensors are mounted: the tree of transforms that do not change.
#pragma once

#include "import/rosbag/ros_messages.hpp"

#include <map>
#include <optional>
#include <string>

namespace waymark {

/// tf_static, or the tree that is sent again and again (`tf`), in which old robots have both what
/// moves and what does not.
enum class TransformSource { kStatic, kRepeated };

/// Frames, each fixed in its parent. A repeated transform counts as fixed for as long as it stays
/// the same; tf_static overrules it.
class StaticFrames {
 public:
  void add(const RosTransform& transform, TransformSource source);

  /// Nothing when no fixed transforms lead from one to the other.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& child) const;

 private:
  struct Link {
    std::string parent{};
    Eigen::Isometry3d parent_from_child{};
    TransformSource source{TransformSource::kStatic};
    bool moves{false};
  };

  /// The topmost frame above one, and its pose in there.
  Link root_of(const std::string& frame) const;

  std::map<std::string, Link> parents_{};
};

}  // namespace waymark

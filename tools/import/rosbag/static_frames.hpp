// SPDX-License-Identifier: BSD-3-Clause
// The tree of fixed transforms, for the mounting of sensors.
#pragma once

#include "import/rosbag/ros_messages.hpp"

#include <map>
#include <optional>
#include <string>

namespace waymark {

/// Topic of a transform: tf_static, or tf, on which old robots repeat fixed transforms as well.
enum class TransformSource { kStatic, kRepeated };

/// Fixed transforms by child frame. A transform of tf counts as fixed as long as all its messages
/// agree; tf_static overrides it.
class StaticFrames {
 public:
  void add(const RosTransform& transform, TransformSource source);

  /// parent_from_child; nothing if no chain of fixed transforms connects the two.
  std::optional<Eigen::Isometry3d> find(const std::string& parent, const std::string& child) const;

 private:
  struct Link {
    std::string parent{};
    Eigen::Isometry3d parent_from_child{};
    TransformSource source{TransformSource::kStatic};
    bool moves{false};
  };

  /// Root of the tree that `frame` is in, and the frame's pose in it.
  Link root_of(const std::string& frame) const;

  std::map<std::string, Link> parents_{};
};

}  // namespace waymark

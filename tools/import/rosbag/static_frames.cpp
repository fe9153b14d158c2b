// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/static_frames.hpp"

namespace waymark {
namespace {

constexpr double kSame = 1e-6;  // rounding of repeated transforms [m, rotation matrix elements]

/// "/base_link" of ROS 1 is "base_link".
std::string frame_name(const std::string& name) {
  return name.starts_with('/') ? name.substr(1) : name;
}

}  // namespace

void StaticFrames::add(const RosTransform& transform, TransformSource source) {
  const std::string child = frame_name(transform.child);
  const Link link{frame_name(transform.parent), transform.parent_from_child, source};
  const auto [known, is_new] = parents_.try_emplace(child, link);
  if (is_new) return;
  Link& before = known->second;
  if (source == TransformSource::kStatic) {
    before = link;
  } else if (before.source == TransformSource::kRepeated) {
    before.moves |= before.parent != link.parent ||
                    !before.parent_from_child.isApprox(link.parent_from_child, kSame);
  }
}

StaticFrames::Link StaticFrames::root_of(const std::string& frame) const {
  Link root{frame_name(frame), Eigen::Isometry3d::Identity()};
  // At most as many steps as frames: damaged transforms may form a cycle.
  for (std::size_t i = 0; i < parents_.size(); ++i) {
    const auto link = parents_.find(root.parent);
    if (link == parents_.end() || link->second.moves) break;
    root.parent_from_child = link->second.parent_from_child * root.parent_from_child;
    root.parent = link->second.parent;
  }
  return root;
}

std::optional<Eigen::Isometry3d> StaticFrames::find(const std::string& parent,
                                                    const std::string& child) const {
  const Link above_parent = root_of(parent);
  const Link above_child = root_of(child);
  if (above_parent.parent != above_child.parent) return std::nullopt;
  return above_parent.parent_from_child.inverse() * above_child.parent_from_child;
}

}  // namespace waymark

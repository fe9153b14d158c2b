// SPDX-License-Identifier: BSD-3-Clause
// Planar trajectories in TUM files, and interpolation.
#pragma once

#include "common/geometry/se2.hpp"
#include "evaluate/files/text_file.hpp"

#include <filesystem>
#include <optional>
#include <vector>

namespace waymark::evaluate {

struct StampedPose {
  double t_s{};
  Se2 parent_from_base{};
};

/// At least one pose; times strictly increase.
using Trajectory = std::vector<StampedPose>;

/// Lines `t x y z qx qy qz qw`; z is ignored, the yaw is taken from the quaternion. '#' starts a
/// comment. Lines of another form and lines whose time does not advance are added to `skipped`.
/// @throws SetupError if the file cannot be read or has no pose.
Trajectory read_tum(const std::filesystem::path& file, SkippedLines& skipped);

/// Interpolated pose at a time; nullopt outside the trajectory's span. Times are stored with six
/// decimals, so that one microsecond outside counts as inside.
std::optional<Se2> pose_at(const Trajectory& trajectory, double t_s);

}  // namespace waymark::evaluate

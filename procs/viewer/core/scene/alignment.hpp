// SPDX-License-Identifier: BSD-3-Clause
// Transforms paths of other frames into the map frame, by their pose at the first estimate.
#pragma once

#include "viewer/core/scene/scene.hpp"

#include <optional>
#include <span>
#include <vector>

namespace waymark::viewer {

/// Pose at a time, interpolated; nullopt outside the path's times.
std::optional<Se2> pose_at(std::span<const TimedPose> path, Timestamp time);

/// The path in the map frame, moved through the first estimate within the path's times:
/// map_from_frame = map_from_base * inverse(frame_from_base), both at that estimate's time. Empty
/// when no estimate is within the path's times. For pictures: this is not the best fit.
std::vector<TimedPose> aligned_on_first(std::span<const EstimatedPose> estimates,
                                        std::span<const TimedPose> path);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/alignment.hpp"

#include <algorithm>

namespace waymark::viewer {

std::optional<Se2> pose_at(std::span<const TimedPose> path, Timestamp time) {
  const auto after = std::lower_bound(path.begin(), path.end(), time,
                                      [](const TimedPose& p, Timestamp t) { return p.time < t; });
  if (after == path.end()) return std::nullopt;
  if (after->time == time) return after->frame_from_base;
  if (after == path.begin()) return std::nullopt;
  const auto before = std::prev(after);
  const double fraction = to_seconds(time - before->time) / to_seconds(after->time - before->time);
  return interpolate(before->frame_from_base, after->frame_from_base, fraction);
}

std::vector<TimedPose> aligned_on_first(std::span<const EstimatedPose> estimates,
                                        std::span<const TimedPose> path) {
  std::vector<TimedPose> path_in_map;
  for (const EstimatedPose& estimate : estimates) {
    const auto frame_from_base = pose_at(path, estimate.time);
    if (!frame_from_base) continue;
    const Se2 map_from_frame = estimate.map_from_base * frame_from_base->inverse();
    path_in_map.reserve(path.size());
    for (const TimedPose& pose : path)
      path_in_map.push_back({pose.time, map_from_frame * pose.frame_from_base});
    break;
  }
  return path_in_map;
}

}  // namespace waymark::viewer

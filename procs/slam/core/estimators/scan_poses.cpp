// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/scan_poses.hpp"

#include <algorithm>

namespace waymark {
namespace {

Se2 map_from_scan(const ScanPose& scan, const PoseSequence& keyframes) {
  return keyframes[scan.keyframe] * scan.keyframe_from_base;
}

}  // namespace

void ScanPoses::spread_motion(const ScanPose& start, const ScanPose& end,
                              const PoseSequence& keyframes) {
  ScanPose known = start;
  auto scan = std::find_if(scans_.rbegin(), scans_.rend(), [&known](const auto& earlier) {
                return earlier.clock_s <= known.clock_s;
              }).base();
  while (scan != scans_.end()) {
    const auto next =
        std::find_if(scan, scans_.end(), [](const auto& later) { return later.is_observed; });
    const ScanPose& then = next != scans_.end() ? *next : end;
    const Se2 moved = map_from_scan(known, keyframes).inverse() * map_from_scan(then, keyframes);
    const double whole_s = then.clock_s - known.clock_s;
    for (; scan != next; ++scan) {
      const double share = (scan->clock_s - known.clock_s) / whole_s;
      scan->keyframe = known.keyframe;
      scan->keyframe_from_base = known.keyframe_from_base * interpolate(Se2{}, moved, share);
    }
    if (next == scans_.end()) return;
    known = *next;
    ++scan;
  }
}

std::vector<TimedPose> ScanPoses::along(const PoseSequence& keyframes) const {
  std::vector<TimedPose> trajectory;
  trajectory.reserve(scans_.size());
  for (const ScanPose& scan : scans_)
    trajectory.push_back({scan.time, map_from_scan(scan, keyframes)});
  return trajectory;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/estimators/scan_trajectory.hpp"

#include <algorithm>
#include <cassert>

namespace waymark {
namespace {

/// Weight of turning relative to driving when a difference is distributed.
constexpr double kMetresPerRadian = 1.0;

double effort(const Motion& motion) {
  return motion.distance_m + kMetresPerRadian * motion.turn_rad;
}

}  // namespace

void ScanTrajectory::add(Timestamp time, const Motion& motion, bool is_update) {
  assert(is_update || !scans_.empty());
  const bool continues = !scans_.empty() && !scans_.back().is_update;
  scans_.push_back({time, continues ? scans_.back().since_update.then(motion) : motion, is_update});
}

std::vector<TimedPose> ScanTrajectory::along(std::span<const Se2> map_from_updates) const {
  std::vector<TimedPose> poses;
  poses.reserve(scans_.size());
  std::size_t update = 0;  // number of updates passed
  for (auto scan = scans_.begin(); scan != scans_.end();) {
    const auto next = std::find_if(scan, scans_.end(), [](const Scan& s) { return s.is_update; });
    const Se2 map_from_last = update > 0 ? map_from_updates[update - 1] : Se2{};
    Se2 left_over{};
    double whole = 0.0;
    if (next != scans_.end() && update > 0) {
      left_over =
          (map_from_last * next->since_update.start_from_end).inverse() * map_from_updates[update];
      whole = effort(next->since_update);
    }
    for (; scan != next; ++scan) {
      const double share = whole > 0.0 ? effort(scan->since_update) / whole : 0.0;
      poses.push_back({scan->time, map_from_last * scan->since_update.start_from_end *
                                       interpolate(Se2{}, left_over, share)});
    }
    if (next == scans_.end()) break;
    poses.push_back({next->time, map_from_updates[update++]});
    ++scan;
  }
  return poses;
}

}  // namespace waymark

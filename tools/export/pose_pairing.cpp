// SPDX-License-Identifier: BSD-3-Clause
#include "export/pose_pairing.hpp"

#include <algorithm>
#include <utility>

namespace waymark::exporting {
namespace {

constexpr Duration kMaxGap = std::chrono::seconds{1};  // between two poses to interpolate
constexpr std::size_t kMaxPoses = 2000;

}  // namespace

void PosePairing::add_pose(const viewer::TimedPose& frame_from_base) {
  if (held_back_ && frame_from_base.time > held_back_->time) {
    accept(*std::exchange(held_back_, frame_from_base));
  } else if (is_newer(frame_from_base.time)) {
    if (std::exchange(held_back_, frame_from_base)) ++num_dropped_poses_;
  } else if (clock_steps_.note_inconsistent(frame_from_base.time)) {
    begin_anew(frame_from_base);
  } else {
    ++num_dropped_poses_;
  }
}

void PosePairing::begin_anew(const viewer::TimedPose& pose) {
  finish();
  poses_.clear();
  held_back_ = pose;
}

void PosePairing::finish() {
  if (const auto last = std::exchange(held_back_, std::nullopt)) accept(*last);
  num_unpaired_ += std::ssize(waiting_);
  waiting_.clear();
}

void PosePairing::accept(const viewer::TimedPose& pose) {
  clock_steps_.note_consistent();
  poses_.push_back(pose);
  if (poses_.size() > kMaxPoses) poses_.pop_front();
  new_poses_.push_back(pose);
  for (const viewer::TimedPose& estimate : std::exchange(waiting_, {}))
    add_estimate(estimate);
}

void PosePairing::add_estimate(const viewer::TimedPose& map_from_base) {
  const Timestamp time = map_from_base.time;
  if (is_newer(time)) {
    waiting_.push_back(map_from_base);
  } else if (const auto frame_from_base = pose_at(time)) {
    new_pairs_.push_back({time, map_from_base.frame_from_base, *frame_from_base});
  } else {
    ++num_unpaired_;
  }
}

std::optional<Se2> PosePairing::pose_at(Timestamp time) const {
  const auto after = std::ranges::lower_bound(poses_, time, {}, &viewer::TimedPose::time);
  if (after == poses_.end()) return std::nullopt;
  if (after->time == time) return after->frame_from_base;
  if (after == poses_.begin()) return std::nullopt;
  const viewer::TimedPose& before = *(after - 1);
  if (after->time - before.time > kMaxGap) return std::nullopt;
  const double fraction = to_seconds(time - before.time) / to_seconds(after->time - before.time);
  return interpolate(before.frame_from_base, after->frame_from_base, fraction);
}

std::vector<viewer::TimedPose> PosePairing::take_poses() {
  return std::exchange(new_poses_, {});
}

std::vector<PosePair> PosePairing::take_pairs() {
  return std::exchange(new_pairs_, {});
}

}  // namespace waymark::exporting

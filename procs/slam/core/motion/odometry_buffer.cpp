// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/motion/odometry_buffer.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <iterator>

namespace waymark {
namespace {

bool is_other(const Se2& a, const Se2& b) {
  return a.translation() != b.translation() || a.theta() != b.theta();
}

}  // namespace

OdometryBuffer::Outcome OdometryBuffer::add(const OdometrySample& sample) {
  Outcome outcome = Outcome::kAdded;
  if (!samples_.empty()) {
    if (sample.time <= newest()) return Outcome::kOutOfOrder;
    if (sample.time > newest() + ClockWatch::kLongestPause) return Outcome::kTooFarAhead;
    const double elapsed_s = to_seconds(sample.time - newest());
    const Se2 step = last_raw_.inverse() * sample.odom_from_base;
    if (!(step.translation().norm() <= kMaxSpeed_m_s * elapsed_s) ||
        !(std::abs(step.theta()) <= kMaxTurnRate_rad_s * elapsed_s)) {
      smooth_from_raw_ = samples_.back().odom_from_base * sample.odom_from_base.inverse();
      outcome = Outcome::kJumped;
      if (has_kept_back(step, sample)) {
        outcome = Outcome::kCaughtUp;
        catch_up_ = {sample.time, Motion::between(last_raw_, sample.odom_from_base)};
      }
    }
  }
  if (samples_.empty() || is_other(sample.odom_from_base, last_raw_)) changed_ = sample.time;
  last_raw_ = sample.odom_from_base;
  samples_.push_back({sample.time, smooth_from_raw_ * sample.odom_from_base, smooth_from_raw_});
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  return outcome;
}

/// Odometry that begins anew does so at the origin.
bool OdometryBuffer::has_kept_back(const Se2& step, const OdometrySample& sample) const {
  const double stuck_s = to_seconds(newest() - changed_);
  return is_other(sample.odom_from_base, Se2{}) &&
         step.translation().norm() <= kMaxDrive_m_s * stuck_s &&
         std::abs(step.theta()) <= kMaxDrive_rad_s * stuck_s;
}

std::optional<Motion> OdometryBuffer::kept_back(Timestamp from, Timestamp to) const {
  if (!catch_up_ || catch_up_->time <= from || catch_up_->time > to) return std::nullopt;
  return catch_up_->motion;
}

std::deque<OdometryBuffer::Sample>::const_iterator OdometryBuffer::sample_from(
    Timestamp time) const {
  return std::lower_bound(
      samples_.begin(), samples_.end(), time,
      [](const Sample& sample, Timestamp wanted) { return sample.time < wanted; });
}

std::optional<Timestamp> OdometryBuffer::first_from(Timestamp time) const {
  const auto sample = sample_from(time);
  return sample == samples_.end() ? std::nullopt : std::optional{sample->time};
}

Se2 OdometryBuffer::pose_at(Timestamp time) const {
  assert(covers(time));
  const auto after = sample_from(time);
  if (after->time == time) return after->odom_from_base;
  const auto before = std::prev(after);
  const double fraction = to_seconds(time - before->time) / to_seconds(after->time - before->time);
  return interpolate(before->odom_from_base, after->odom_from_base, fraction);
}

Se2 OdometryBuffer::sent_pose_at(Timestamp time) const {
  assert(covers(time));
  const auto after = sample_from(time);
  const auto before = after->time == time ? after : std::prev(after);
  return before->smooth_from_raw.inverse() * pose_at(time);
}

Motion OdometryBuffer::motion_between(Timestamp from, Timestamp to) const {
  Motion motion;
  Se2 odom_from_last = pose_at(from);
  for (const Sample& sample : samples_) {
    if (sample.time <= from || sample.time >= to) continue;
    motion = motion.then(Motion::between(odom_from_last, sample.odom_from_base));
    odom_from_last = sample.odom_from_base;
  }
  return motion.then(Motion::between(odom_from_last, pose_at(to)));
}

void OdometryBuffer::shift(Duration later) {
  for (Sample& sample : samples_)
    sample.time += later;
  changed_ += later;
  if (catch_up_) catch_up_->time += later;
}

void OdometryBuffer::forget_before(Timestamp time) {
  while (samples_.size() >= 2 && samples_[1].time <= time) {
    samples_.pop_front();
  }
}

}  // namespace waymark

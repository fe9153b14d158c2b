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

bool is_at_origin(const Se2& odom_from_base) {
  return !is_other(odom_from_base, Se2{});
}

}  // namespace

OdometryBuffer::Outcome OdometryBuffer::add(const OdometrySample& sample) {
  Outcome outcome = Outcome::kAdded;
  if (!samples_.empty()) {
    if (sample.time <= newest()) return Outcome::kOutOfOrder;
    if (sample.time > newest() + ClockStepDetector::kLongestPause) return Outcome::kTooFarAhead;
    outcome = add_newer(sample);
  }
  if (samples_.empty() || is_other(sample.odom_from_base, last_raw_)) changed_ = sample.time;
  last_raw_ = sample.odom_from_base;
  const bool is_held = jump_ || outcome == Outcome::kCaughtUp;
  samples_.push_back(
      {sample.time,
       is_held ? samples_.back().odom_from_base : smooth_from_raw_ * sample.odom_from_base,
       smooth_from_raw_});
  if (samples_.size() > kMaxSamples) samples_.pop_front();
  return outcome;
}

OdometryBuffer::Outcome OdometryBuffer::add_newer(const OdometrySample& sample) {
  const double elapsed_s = to_seconds(sample.time - newest());
  const Se2 step = last_raw_.inverse() * sample.odom_from_base;
  const bool has_stood = to_seconds(newest() - changed_) >= kStood_s;
  const double most_m = (has_stood ? kMaxDrive_m_s : kMaxSpeed_m_s) * elapsed_s;
  const double most_rad = (has_stood ? kMaxDrive_rad_s : kMaxTurnRate_rad_s) * elapsed_s;
  const bool is_reset =
      is_at_origin(sample.odom_from_base) &&
      (step.translation().norm() > kReset_m || std::abs(step.theta()) > kReset_rad);
  const bool jumps =
      is_reset || !(step.translation().norm() <= most_m) || !(std::abs(step.theta()) <= most_rad);
  if (!jumps && !jump_) return Outcome::kAdded;
  const Se2 held = samples_.back().odom_from_base;
  if (!jump_ && is_catching_up(step, sample)) {
    catch_up_ = {sample.time, Motion::between(last_raw_, sample.odom_from_base)};
    smooth_from_raw_ = held * sample.odom_from_base.inverse();
    return Outcome::kCaughtUp;
  }
  if (!jump_) {
    jump_ = Jump{{newest(), last_raw_}, sample.odom_from_base, 0};
    jump_interval_ = Interval{newest(), sample.time};
  }
  smooth_from_raw_ = held * sample.odom_from_base.inverse();
  return resolve_jump(sample, jumps);
}

OdometryBuffer::Outcome OdometryBuffer::resolve_jump(const OdometrySample& sample, bool jumps) {
  jump_interval_->to = sample.time;
  if (jumps) jump_->begin = sample.odom_from_base;
  jump_->consistent = jumps ? 0 : jump_->consistent + 1;
  if (jump_->consistent < kConsistentSamples) return jumps ? Outcome::kJumped : Outcome::kAdded;
  const Jump jump = *jump_;
  jump_.reset();
  const Se2 since = jump.before.odom_from_base.inverse() * sample.odom_from_base;
  const double elapsed_s = to_seconds(sample.time - jump.before.time);
  const bool went_on = !is_at_origin(jump.begin) &&
                       since.translation().norm() <= kMaxDrive_m_s * elapsed_s &&
                       std::abs(since.theta()) <= kMaxDrive_rad_s * elapsed_s;
  if (went_on) {
    catch_up_ = {sample.time, Motion::between(jump.before.odom_from_base, sample.odom_from_base)};
    return Outcome::kCaughtUp;
  }
  // A reset: only the motion within the consistent samples was driven.
  smooth_from_raw_ = samples_.back().odom_from_base * jump.begin.inverse();
  return Outcome::kAdded;
}

/// A jump to the odometry's origin is a reset.
bool OdometryBuffer::is_catching_up(const Se2& step, const OdometrySample& sample) const {
  const double stuck_s = to_seconds(newest() - changed_);
  return !is_at_origin(sample.odom_from_base) &&
         step.translation().norm() <= kMaxDrive_m_s * stuck_s &&
         std::abs(step.theta()) <= kMaxDrive_rad_s * stuck_s;
}

std::optional<Motion> OdometryBuffer::late_motion(Timestamp from, Timestamp to) const {
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
  if (jump_) jump_->before.time += later;
  if (jump_interval_) *jump_interval_ = {jump_interval_->from + later, jump_interval_->to + later};
}

void OdometryBuffer::forget_before(Timestamp time) {
  while (samples_.size() >= 2 && samples_[1].time <= time) {
    samples_.pop_front();
  }
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/input/odometry_stream.hpp"

#include <algorithm>
#include <utility>

namespace waymark {
namespace {

void count(OdometryBuffer::Outcome outcome, Skips& skips) {
  switch (outcome) {
    case OdometryBuffer::Outcome::kAdded:
      break;
    case OdometryBuffer::Outcome::kOutOfOrder:
      return skips.add(Skip::kOdometryOutOfOrder);
    case OdometryBuffer::Outcome::kTooFarAhead:
      return skips.add(Skip::kOdometryAhead);
    case OdometryBuffer::Outcome::kJumped:
      return skips.add(Skip::kOdometryJumped);
    case OdometryBuffer::Outcome::kCaughtUp:
      return skips.add(Skip::kOdometryStuck);
  }
}

bool is_refused(OdometryBuffer::Outcome outcome) {
  return outcome == OdometryBuffer::Outcome::kOutOfOrder ||
         outcome == OdometryBuffer::Outcome::kTooFarAhead;
}

}  // namespace

OdometryStream::News OdometryStream::add(const OdometrySample& sample, Skips& skips) {
  if (held_) resolve_held(sample, skips);
  if (shows_first_was_ahead(sample)) {
    skips.add(Skip::kOdometryAhead);
    buffer_ = {};
  }
  if (!is_to_be_held(sample)) return accept(sample, skips);
  held_ = sample;
  return {};
}

void OdometryStream::finish(Skips& skips) {
  if (const auto held = std::exchange(held_, std::nullopt)) accept(*held, skips);
}

/// Accepts or drops the sample that is held back, depending on the next one.
void OdometryStream::resolve_held(const OdometrySample& sample, Skips& skips) {
  if (sample.time > held_->time) {
    const OdometrySample held = *std::exchange(held_, std::nullopt);
    accept(held, skips);
  } else if (sample.time > buffer_.newest()) {
    held_.reset();
    skips.add(Skip::kOdometryAhead);
  }
}

bool OdometryStream::is_to_be_held(const OdometrySample& sample) const {
  if (buffer_.is_empty()) return false;
  const Duration step = sample.time - buffer_.newest();
  return step > 2 * usual_step_ && step <= ClockStepDetector::kLongestPause;
}

/// Whether the very first sample, which could not be checked, was stamped ahead.
bool OdometryStream::shows_first_was_ahead(const OdometrySample& sample) const {
  return buffer_.has_one() && !has_been_read_ && sample.time < buffer_.newest() &&
         sample.time >= buffer_.newest() - kLongestLead;
}

OdometryStream::News OdometryStream::accept(const OdometrySample& sample, Skips& skips) {
  News news;
  const bool is_first = buffer_.is_empty();
  const Duration step = is_first ? kLongestStep : sample.time - buffer_.newest();
  const auto outcome = buffer_.add(sample);
  count(outcome, skips);
  if (!is_refused(outcome)) {
    usual_step_ = std::min(step, 2 * usual_step_);
    clock_steps_.note_consistent();
    news.is_first = is_first;
  } else if (clock_steps_.note_inconsistent(sample.time)) {
    news.clock_set = set_clock(skips);
    count(buffer_.add(sample), skips);
  }
  return news;
}

/// Shifts the stamps of old samples so that odometry continues without a gap: no motion is lost.
/// @return the shift.
Duration OdometryStream::set_clock(Skips& skips) {
  skips.add(Skip::kClockSet);
  const Duration later = clock_steps_.first_inconsistent() - buffer_.newest();
  buffer_.shift(later);
  if (std::exchange(held_, std::nullopt)) skips.add(Skip::kOdometryAhead);
  return later;
}

}  // namespace waymark

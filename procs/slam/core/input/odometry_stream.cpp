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
  if (leading_) weigh_leading(sample, skips);
  if (shows_first_was_ahead(sample)) {
    skips.add(Skip::kOdometryAhead);
    buffer_ = {};
  }
  if (!leads(sample)) return take(sample, skips);
  leading_ = sample;
  return {};
}

void OdometryStream::finish(Skips& skips) {
  if (const auto leading = std::exchange(leading_, std::nullopt)) take(*leading, skips);
}

/// Accepts or drops the sample that is held back, depending on the next one.
void OdometryStream::weigh_leading(const OdometrySample& sample, Skips& skips) {
  if (sample.time > leading_->time) {
    const OdometrySample leading = *std::exchange(leading_, std::nullopt);
    take(leading, skips);
  } else if (sample.time > buffer_.newest()) {
    leading_.reset();
    skips.add(Skip::kOdometryAhead);
  }
}

bool OdometryStream::leads(const OdometrySample& sample) const {
  if (buffer_.is_empty()) return false;
  const Duration step = sample.time - buffer_.newest();
  return step > 2 * usual_step_ && step <= ClockStepDetector::kLongestPause;
}

/// Whether the very first sample, which could not be checked, was stamped ahead.
bool OdometryStream::shows_first_was_ahead(const OdometrySample& sample) const {
  return buffer_.has_one() && !has_been_read_ && sample.time < buffer_.newest() &&
         sample.time >= buffer_.newest() - kLongestLead;
}

OdometryStream::News OdometryStream::take(const OdometrySample& sample, Skips& skips) {
  News news;
  const bool is_first = buffer_.is_empty();
  const Duration step = is_first ? kLongestStep : sample.time - buffer_.newest();
  const auto outcome = buffer_.add(sample);
  count(outcome, skips);
  if (!is_refused(outcome)) {
    usual_step_ = std::min(step, 2 * usual_step_);
    clock_steps_.see_fitting();
    news.is_first = is_first;
  } else if (clock_steps_.see_misfit(sample.time)) {
    news.clock_set = set_clock(skips);
    count(buffer_.add(sample), skips);
  }
  return news;
}

/// Shifts the stamps of old samples so that odometry continues without a gap: no motion is lost.
/// @return the shift.
Duration OdometryStream::set_clock(Skips& skips) {
  skips.add(Skip::kClockSet);
  const Duration later = clock_steps_.first_misfit() - buffer_.newest();
  buffer_.shift(later);
  if (std::exchange(leading_, std::nullopt)) skips.add(Skip::kOdometryAhead);
  return later;
}

}  // namespace waymark

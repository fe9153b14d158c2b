// SPDX-License-Identifier: BSD-3-Clause
#include "common/time/clock_step_detector.hpp"

namespace waymark {
namespace {

constexpr int kConsecutive = 20;                     // stamps after which the clock counts as set
constexpr Duration kNear = std::chrono::seconds{2};  // between consistent stamps, at most

}  // namespace

bool ClockStepDetector::see_misfit(Timestamp time) {
  const bool agrees = misfits_ > 0 && time >= last_misfit_ - kNear && time <= last_misfit_ + kNear;
  if (!agrees) {
    misfits_ = 0;
    first_misfit_ = time;
  }
  last_misfit_ = time;
  if (++misfits_ < kConsecutive) return false;
  misfits_ = 0;
  return true;
}

}  // namespace waymark

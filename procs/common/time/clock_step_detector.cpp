// SPDX-License-Identifier: BSD-3-Clause
#include "common/time/clock_step_detector.hpp"

namespace waymark {
namespace {

// So many consecutive inconsistent stamps, each near the one before, mean that the clock was set.
constexpr int kConsecutive = 20;
constexpr Duration kNear = std::chrono::seconds{2};

}  // namespace

bool ClockStepDetector::note_inconsistent(Timestamp time) {
  const bool is_near = num_inconsistent_ > 0 && time >= last_inconsistent_ - kNear &&
                       time <= last_inconsistent_ + kNear;
  if (!is_near) {
    num_inconsistent_ = 0;
    first_inconsistent_ = time;
  }
  last_inconsistent_ = time;
  if (++num_inconsistent_ < kConsecutive) return false;
  num_inconsistent_ = 0;
  return true;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Distinguishes a step of the clock from single wrong stamps.
#pragma once

#include "common/time/time.hpp"

namespace waymark {

/// After a step of the clock (a computer without a battery finds its time server, a log starts
/// again) all stamps are inconsistent with those before; after a single wrong stamp, the next one
/// is consistent again.
class ClockStepDetector {
 public:
  /// A stamp later than all before by more than this is inconsistent.
  static constexpr Duration kLongestPause = std::chrono::minutes{10};

  void see_fitting() { misfits_ = 0; }

  /// @return true when the clock was set: many inconsistent stamps in a row are consistent with
  /// each other.
  bool see_misfit(Timestamp time);

  /// The first of the present run of inconsistent stamps.
  Timestamp first_misfit() const { return first_misfit_; }

 private:
  int misfits_{0};
  Timestamp first_misfit_{};
  Timestamp last_misfit_{};
};

}  // namespace waymark

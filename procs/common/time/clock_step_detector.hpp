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

  /// A stamp consistent with those before has come.
  void note_consistent() { num_inconsistent_ = 0; }

  /// An inconsistent stamp has come.
  /// @return true when the clock was set: many inconsistent stamps in a row are consistent with
  /// each other.
  bool note_inconsistent(Timestamp time);

  /// The first of the present run of inconsistent stamps.
  Timestamp first_inconsistent() const { return first_inconsistent_; }

 private:
  int num_inconsistent_{0};
  Timestamp first_inconsistent_{};
  Timestamp last_inconsistent_{};
};

}  // namespace waymark

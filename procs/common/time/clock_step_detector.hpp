// SPDX-License-Identifier: BSD-3-Clause
// Whether the clock that stamps messages was set, or single stamps are wrong.
#pragma once

#include "common/time/time.hpp"

namespace waymark {

/// A computer without a battery finds its time server, a log begins anew: from then on no stamp
/// fits what came before. One that is wrong is followed by one that fits.
class ClockStepDetector {
 public:
  /// A stamp later than everything by more than this is wrong, until others agree.
  static constexpr Duration kLongestPause = std::chrono::minutes{10};

  void see_fitting() { misfits_ = 0; }

  /// @return true when the clock was set: so many stamps in a row do not fit what came before, but
  /// each other.
  bool see_misfit(Timestamp time);

  /// Of the stamps that agree now.
  Timestamp first_misfit() const { return first_misfit_; }

 private:
  int misfits_{0};
  Timestamp first_misfit_{};
  Timestamp last_misfit_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Limits repeated work to a share of the wall-clock time.
#pragma once

#include <chrono>

namespace waymark::viewer {

/// After work that took c, the next work may start c / max_share after the start of that work. Uses
/// wall-clock time, so results must not depend on it.
class Pacer {
 public:
  using Clock = std::chrono::steady_clock;

  /// @param max_share  largest share of the time for the work, in (0, 1]; 1 = no pause.
  explicit Pacer(double max_share) : max_share_{max_share} {}

  bool may_start(Clock::time_point now) const { return now >= next_start_; }

  void record_work(Clock::time_point start, Clock::time_point end) {
    const std::chrono::duration<double> pause = (end - start) / max_share_;
    next_start_ = start + std::chrono::duration_cast<Clock::duration>(pause);
  }

 private:
  double max_share_;
  Clock::time_point next_start_{Clock::time_point::min()};
};

}  // namespace waymark::viewer

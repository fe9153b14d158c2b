// SPDX-License-Identifier: BSD-3-Clause
// Progress of long work on standard error, where it can be written.
#pragma once

#include <chrono>
#include <string>

namespace waymark {

/// A bar on a terminal (or when $WAYMARK_PROGRESS_BAR is set, for a terminal at the other end of a
/// pipe); elsewhere a line every ten per cent.
class Progress {
 public:
  explicit Progress(std::string what);

  /// @param fraction  of the work done, 0..1
  void show(double fraction, const std::string& detail);
  /// Ends the line of the bar.
  void done();
  /// Wall-clock seconds since construction.
  double elapsed_s() const;

 private:
  std::string what_;
  bool is_terminal_;
  bool line_is_open_{false};
  int last_tenth_{-1};
  std::chrono::steady_clock::time_point start_;
  std::chrono::steady_clock::time_point last_shown_{};
};

/// Peak resident memory of this process [MB].
double peak_memory_mb();

}  // namespace waymark

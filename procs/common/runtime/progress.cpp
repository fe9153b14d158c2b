// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/progress.hpp"

#include <fmt/format.h>
#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

namespace waymark {
namespace {

/// Ignores errors, so that the work goes on if the terminal is gone or the disk full.
void show_text(const std::string& text) {
  std::fputs(text.c_str(), stderr);
  std::fflush(stderr);
}

}  // namespace

Progress::Progress(std::string what)
    : what_{std::move(what)},
      is_terminal_{isatty(STDERR_FILENO) == 1 || std::getenv("WAYMARK_PROGRESS_BAR") != nullptr},
      start_{std::chrono::steady_clock::now()} {}

void Progress::show(double fraction, const std::string& detail) {
  constexpr std::chrono::milliseconds kRedraw{200};
  constexpr int kBarWidth = 24;
  const double done = std::clamp(fraction, 0.0, 1.0);
  const auto now = std::chrono::steady_clock::now();
  if (is_terminal_) {
    if (now - last_shown_ < kRedraw) return;
    const int filled = static_cast<int>(done * kBarWidth);
    show_text(fmt::format("\r{} [{}{}] {:3.0f} %  {}\x1b[K", what_, std::string(filled, '#'),
                          std::string(kBarWidth - filled, '.'), 100.0 * done, detail));
    line_is_open_ = true;
  } else {
    const int tenth = static_cast<int>(done * 10.0);
    if (tenth == last_tenth_) return;
    last_tenth_ = tenth;
    show_text(fmt::format("{} {:3.0f} %  {}\n", what_, 100.0 * done, detail));
  }
  last_shown_ = now;
}

void Progress::done() {
  if (line_is_open_) show_text("\n");
  line_is_open_ = false;
}

double Progress::elapsed_s() const {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start_).count();
}

double peak_memory_mb() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

}  // namespace waymark

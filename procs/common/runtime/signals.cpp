// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/signals.hpp"

#include <unistd.h>

#include <atomic>
#include <csignal>
#include <cstdint>
#include <ctime>
#include <initializer_list>

namespace waymark {
namespace {

volatile std::sig_atomic_t g_stop_signal = 0;
std::atomic<std::int64_t> g_stopped_ms{0};

// timeout(1) and some supervisors signal a process and then its group: signals this close together
// count as one.
constexpr std::int64_t kSameRequest_ms = 300;

std::int64_t now_ms() {
  timespec now{};
  clock_gettime(CLOCK_MONOTONIC, &now);
  return 1000 * now.tv_sec + now.tv_nsec / 1'000'000;
}

void on_signal(int signal) {
  if (g_stop_signal == 0) {
    g_stopped_ms = now_ms();
    g_stop_signal = signal;
  } else if (now_ms() - g_stopped_ms > kSameRequest_ms) {
    _exit(128 + signal);
  }
}

}  // namespace

void install_stop_signals() {
  for (const int signal : {SIGINT, SIGTERM, SIGHUP}) {
    struct sigaction action {};

    action.sa_handler = on_signal;
    sigaction(signal, &action, nullptr);
  }
  std::signal(SIGPIPE, SIG_IGN);
}

int stop_signal() {
  return g_stop_signal;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/signals.hpp"

#include <unistd.h>

#include <csignal>
#include <initializer_list>

namespace waymark {
namespace {

volatile std::sig_atomic_t g_stop_signal = 0;

void on_signal(int signal) {
  if (g_stop_signal != 0) _exit(128 + signal);
  g_stop_signal = signal;
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

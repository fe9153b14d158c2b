// SPDX-License-Identifier: BSD-3-Clause
// The status message that every live process sends about once a second.
#pragma once

#include "common/bus/bus.hpp"
#include "common/node/node.hpp"

#include <chrono>
#include <string>

namespace waymark {

/// Sends counters on <NAME>_STATUS, and warns in the log when messages are lost or refused.
class StatusReporter {
 public:
  explicit StatusReporter(std::string_view process_name);

  /// Sends a status unless the last one is less than a second old. @return true if it was sent.
  bool report(Bus& bus, Counters& counters, Timestamp newest, std::string_view state);

 private:
  void warn_of_new_losses(const Counters& counters);

  std::string name_;
  std::string channel_;
  std::chrono::steady_clock::time_point last_{};
  Counters warned_;
};

}  // namespace waymark

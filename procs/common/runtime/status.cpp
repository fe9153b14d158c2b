// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/status.hpp"

#include "common/logging/logging.hpp"

#include <algorithm>
#include <cctype>

namespace waymark {

StatusReporter::StatusReporter(std::string_view process_name) : name_{process_name} {
  std::ranges::transform(name_, std::back_inserter(channel_),
                         [](unsigned char c) { return static_cast<char>(std::toupper(c)); });
  channel_ += "_STATUS";
}

bool StatusReporter::report(Bus& bus, Counters& counters, Timestamp newest,
                            std::string_view state) {
  const auto now = std::chrono::steady_clock::now();
  if (now - last_ < std::chrono::seconds{1}) return false;
  last_ = now;
  bus.collect_counts(counters);
  process_status_t status{};
  status.utime = to_us(newest);
  status.process = name_;
  status.state = state;
  for (const auto& [name, count] : counters.all()) {
    counter_t counter{};
    counter.name = name;
    counter.kind = static_cast<std::int8_t>(count.kind);
    counter.value = count.value;
    status.counters.push_back(counter);
  }
  status.num_counters = static_cast<int>(status.counters.size());
  bus.publish(encode(Channel<process_status_t>{channel_}, status));
  warn_of_new_losses(counters);
  return true;
}

/// Warns whenever a count of lost or rejected messages has doubled, so that the log stays short.
void StatusReporter::warn_of_new_losses(const Counters& counters) {
  for (const auto& [name, count] : counters.all()) {
    const std::int64_t warned = warned_.get(name);
    if (count.kind == CountKind::kEvent || count.value < std::max<std::int64_t>(1, 2 * warned))
      continue;
    logging::warn("{}: {} so far", name, count.value);
    warned_.add(name, count.kind, count.value - warned);
  }
}

}  // namespace waymark

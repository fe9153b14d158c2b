// SPDX-License-Identifier: BSD-3-Clause
#include "common/node/counters.hpp"

namespace waymark {

std::string_view to_string(CountKind kind) {
  switch (kind) {
    case CountKind::kEvent:
      return "event";
    case CountKind::kLoss:
      return "loss";
    case CountKind::kRejection:
      return "rejection";
  }
  return "unknown";
}

void Counters::add(std::string_view name, CountKind kind, std::int64_t value) {
  const auto found = counts_.find(name);
  if (found == counts_.end()) {
    counts_.emplace(name, Count{kind, value});
  } else {
    found->second.value += value;
  }
}

std::int64_t Counters::get(std::string_view name) const {
  const auto found = counts_.find(name);
  return found == counts_.end() ? 0 : found->second.value;
}

std::int64_t Counters::total(CountKind kind) const {
  std::int64_t total = 0;
  for (const auto& [name, count] : counts_) {
    if (count.kind == kind) total += count.value;
  }
  return total;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// What a process counts, each count with its kind.
#pragma once

#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace waymark {

/// Values as in lcmtypes/counter_t.lcm.
enum class CountKind : std::int8_t {
  kEvent,      ///< normal operation
  kLoss,       ///< valid data dropped: late, too fast, or too much
  kRejection,  ///< invalid data refused; a replay with one fails
};

std::string_view to_string(CountKind kind);

struct Count {
  CountKind kind{CountKind::kEvent};
  std::int64_t value{0};
};

/// Named counts, in order of name.
class Counters {
 public:
  /// Adds to the count of this name, which keeps the kind of its first call.
  void add(std::string_view name, CountKind kind = CountKind::kEvent, std::int64_t value = 1);
  std::int64_t get(std::string_view name) const;
  /// Sum over all counts of a kind.
  std::int64_t total(CountKind kind) const;

  const std::map<std::string, Count, std::less<>>& all() const { return counts_; }

 private:
  std::map<std::string, Count, std::less<>> counts_;
};

}  // namespace waymark

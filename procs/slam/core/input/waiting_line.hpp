// SPDX-License-Identifier: BSD-3-Clause
// What of one sensor waits for the others, and which of its stamps are wrong.
#pragma once

#include "common/time/time.hpp"

#include <cstddef>
#include <deque>
#include <optional>
#include <utility>
#include <vector>

namespace waymark {

/// Values (with a member `time`) in order of time. Where one is not newer than those before it,
/// either it is stamped too early or they are stamped too late: it waits aside, and the next one
/// tells. If that is newer than all, the one aside was wrong; if it follows the one aside, those
/// that lead the two were.
template <class Value>
struct WaitingLine {
  std::deque<Value> values{};
  std::optional<Timestamp> newest{};  ///< of all that were in line
  std::optional<Value> aside{};

  /// What comes of a value.
  struct Judgement {
    std::vector<Value> fitting{};  ///< to be pushed, in that order
    std::size_t ahead{0};          ///< stamped too late: were in line and are no more
    std::size_t late{0};           ///< stamped too early, or twice the same
  };

  Judgement judge(Value value) {
    Judgement judgement;
    auto before = std::exchange(aside, std::nullopt);
    if (!newest || value.time > *newest) {
      judgement.late = before ? 1 : 0;
      judgement.fitting.push_back(std::move(value));
    } else if (before && value.time > before->time) {
      judgement.ahead =
          std::erase_if(values, [&](const Value& other) { return other.time >= before->time; });
      judgement.fitting.push_back(std::move(*before));
      judgement.fitting.push_back(std::move(value));
    } else if (value.time < *newest) {
      judgement.late = before ? 1 : 0;
      aside = std::move(value);
    } else {
      judgement.late = 1;
      aside = std::move(before);
    }
    return judgement;
  }

  void push(Value value) {
    newest = value.time;
    values.push_back(std::move(value));
  }

  /// @return the number of values lost.
  std::size_t clear() {
    const std::size_t lost = values.size() + (aside ? 1 : 0);
    *this = {};
    return lost;
  }
};

}  // namespace waymark

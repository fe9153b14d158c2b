// SPDX-License-Identifier: BSD-3-Clause
// Results that do not fit one datagram, as several messages.
#pragma once

#include "common/time/time.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace waymark {

/// Which items one of several messages holds.
struct Part {
  std::size_t begin{0};
  std::size_t size{0};  ///< at most: the last message has fewer

  /// Empty where this part lies beyond the items' end.
  template <class Items>
  auto of(const Items& items) const {
    const std::size_t first = std::min(begin, items.size());
    return std::span{items}.subspan(first, std::min(size, items.size() - first));
  }
};

/// As many messages as `num_items` need, each with its time and number; none for no items.
/// @param add_items  adds the items of a Part to its message.
template <class Type, class AddItems>
std::vector<Type> in_parts(std::size_t num_items, std::size_t per_message, Timestamp time,
                           AddItems add_items) {
  std::vector<Type> messages((num_items + per_message - 1) / per_message);
  for (std::size_t part = 0; part < messages.size(); ++part) {
    Type& message = messages[part];
    message.utime = to_us(time);
    message.part = static_cast<std::int32_t>(part);
    message.num_parts = static_cast<std::int32_t>(messages.size());
    add_items(message, Part{part * per_message, per_message});
  }
  return messages;
}

}  // namespace waymark

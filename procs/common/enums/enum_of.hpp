// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstdint>

namespace waymark {

/// The enumerator with this number; enumerator 0 (kUnknown) for a number outside 0 ... last.
template <class Enum>
constexpr Enum enum_of(std::int64_t number, Enum last) {
  const bool is_known = number >= 0 && number <= static_cast<std::int64_t>(last);
  return is_known ? static_cast<Enum>(number) : Enum{};
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <concepts>
#include <cstddef>
#include <cstdint>

namespace waymark {

/// @param bytes  at least sizeof(Integer) of them.
template <std::integral Integer, class Byte>
Integer read_big_endian(const Byte* bytes) {
  static_assert(sizeof(Byte) == 1);
  std::uint64_t value = 0;
  for (std::size_t i = 0; i < sizeof(Integer); ++i)
    value = (value << 8) | static_cast<std::uint8_t>(bytes[i]);
  return static_cast<Integer>(value);
}

}  // namespace waymark

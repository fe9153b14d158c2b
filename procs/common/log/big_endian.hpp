// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cstddef>
#include <cstdint>

namespace waymark {

/// @param bytes  at least sizeof(Unsigned) of them.
template <class Unsigned, class Byte>
Unsigned read_big_endian(const Byte* bytes) {
  static_assert(sizeof(Byte) == 1);
  Unsigned value = 0;
  for (std::size_t i = 0; i < sizeof(Unsigned); ++i)
    value = static_cast<Unsigned>((value << 8) | static_cast<std::uint8_t>(bytes[i]));
  return value;
}

}  // namespace waymark

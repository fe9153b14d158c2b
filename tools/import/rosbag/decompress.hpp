// SPDX-License-Identifier: BSD-3-Clause
// What bags are compressed with.
#pragma once

#include "import/rosbag/byte_cursor.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace waymark {

/// Larger chunks and messages are taken for damage; rosbag's usual chunk has 0.75 MB.
inline constexpr std::uint64_t kMaxUnpackedBytes = std::uint64_t{256} << 20;

/// @param method  "bz2", "lz4" (frames) or "zstd".
/// @param size    of the result, as the bag says.
/// @return nothing when the bytes are damaged, or of another size, or the method is not known.
std::optional<std::vector<std::uint8_t>> decompress(std::string_view method, ByteView packed,
                                                    std::uint64_t size);

bool is_known_compression(std::string_view method);

/// A message that rosbag2 has compressed by itself, which says its own size; nothing when it is
/// none.
std::optional<std::vector<std::uint8_t>> decompress_zstd_frame(ByteView packed);
bool is_zstd_frame(ByteView bytes);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Decompresses chunks and messages of bags.
#pragma once

#include "import/rosbag/byte_cursor.hpp"

#include <cstdint>
#include <optional>
#include <string_view>
#include <vector>

namespace waymark {

/// Larger sizes are treated as damage; rosbag's default chunk is 0.75 MB.
inline constexpr std::uint64_t kMaxUnpackedBytes = std::uint64_t{256} << 20;

/// @param method  "bz2", "lz4" (frames) or "zstd".
/// @param size    uncompressed size as stored in the bag [bytes].
/// @return nothing if the bytes are damaged, have another size, or the method is unknown.
std::optional<std::vector<std::uint8_t>> decompress(std::string_view method, ByteView packed,
                                                    std::uint64_t size);

bool is_known_compression(std::string_view method);

/// Decompresses a message that rosbag2 compressed on its own (mode "message"); the frame contains
/// its uncompressed size.
/// @return nothing if it is no zstd frame or damaged.
std::optional<std::vector<std::uint8_t>> decompress_zstd_frame(ByteView packed);
bool is_zstd_frame(ByteView bytes);

}  // namespace waymark

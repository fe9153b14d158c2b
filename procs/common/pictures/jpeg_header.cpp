// SPDX-License-Identifier: BSD-3-Clause
#include "common/pictures/jpeg_header.hpp"

#include "common/bytes/big_endian.hpp"

#include <cstddef>

namespace waymark {
namespace {

constexpr std::uint8_t kMarkerPrefix = 0xFF;
constexpr std::uint8_t kStartOfImage = 0xD8;
constexpr std::uint8_t kEndOfImage = 0xD9;
constexpr std::uint8_t kStartOfScan = 0xDA;

/// SOF0 to SOF15, without the other markers in that range (C4, C8, CC).
bool is_frame_header(std::uint8_t marker) {
  return marker >= 0xC0 && marker <= 0xCF && marker != 0xC4 && marker != 0xC8 && marker != 0xCC;
}

bool is_restart(std::uint8_t marker) {
  return marker >= 0xD0 && marker <= 0xD7;
}

/// Position of the next marker's prefix in entropy-coded data, where FF 00 is a data byte.
std::size_t end_of_scan(std::span<const std::uint8_t> bytes, std::size_t at) {
  for (; at + 1 < bytes.size(); ++at) {
    const std::uint8_t next = bytes[at + 1];
    if (bytes[at] == kMarkerPrefix && next != 0x00 && next != kMarkerPrefix && !is_restart(next)) {
      return at;
    }
  }
  return bytes.size();
}

}  // namespace

std::optional<JpegHeader> read_jpeg_header(std::span<const std::uint8_t> bytes) {
  if (bytes.size() < 2 || bytes[0] != kMarkerPrefix || bytes[1] != kStartOfImage) {
    return std::nullopt;
  }
  constexpr std::size_t kFrameHeaderBytes = 9;  // marker, length, precision, height, width
  std::optional<JpegHeader> header;
  std::size_t at = 2;
  while (at + 1 < bytes.size() && bytes[at] == kMarkerPrefix) {
    const std::uint8_t marker = bytes[at + 1];
    if (marker == kMarkerPrefix) {  // fill byte
      ++at;
      continue;
    }
    if (marker == kEndOfImage) {
      if (header) header->complete = true;
      break;
    }
    if (at + 4 > bytes.size()) break;
    const int length = read_big_endian<std::uint16_t>(&bytes[at + 2]);
    if (length < 2) break;
    if (is_frame_header(marker)) {
      // With a second frame header the decoded size could differ from the one that was checked.
      if (header || at + kFrameHeaderBytes > bytes.size()) return std::nullopt;
      header = JpegHeader{read_big_endian<std::uint16_t>(&bytes[at + 7]),
                          read_big_endian<std::uint16_t>(&bytes[at + 5]), false};
    }
    at += 2 + static_cast<std::size_t>(length);
    if (marker == kStartOfScan) at = end_of_scan(bytes, at);
  }
  return header;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Reads the size in a JPEG's header, to check it before a decoder allocates memory for it.
#pragma once

#include <cstdint>
#include <optional>
#include <span>

namespace waymark {

struct JpegHeader {
  int width_px{0};
  int height_px{0};
  bool complete{false};  ///< the end-of-image marker is there
};

/// Walks the segments of a JPEG stream (ITU-T T.81, annex B). nullopt when the bytes are no JPEG
/// stream, or it has no complete frame header, or a second one. Never reads outside the span;
/// allocates nothing.
std::optional<JpegHeader> read_jpeg_header(std::span<const std::uint8_t> bytes);

}  // namespace waymark

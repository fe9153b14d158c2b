// SPDX-License-Identifier: BSD-3-Clause
// Reads numbers and strings from bytes, with bounds checks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <cstring>
#include <span>
#include <string_view>

namespace waymark {

using ByteView = std::span<const std::uint8_t>;

/// Little-endian, unaligned. Reading past the end gives 0 or empty, and good() is false from then
/// on.
class ByteCursor {
 public:
  explicit ByteCursor(ByteView bytes) : bytes_{bytes} {}

  bool good() const { return good_; }

  bool at_end() const { return offset_ == bytes_.size(); }

  std::size_t offset() const { return offset_; }

  std::size_t left() const { return bytes_.size() - offset_; }

  template <class Number>
  Number number() {
    Number value{};
    const ByteView raw = take(sizeof(Number));
    if (good_) std::memcpy(&value, raw.data(), sizeof(Number));  // this machine is little-endian
    return value;
  }

  ByteView take(std::uint64_t count) {
    if (count > left()) good_ = false;
    if (!good_) return {};
    const ByteView taken = bytes_.subspan(offset_, static_cast<std::size_t>(count));
    offset_ += taken.size();
    return taken;
  }

  /// Bytes preceded by their length.
  template <class Length = std::uint32_t>
  ByteView block() {
    return take(number<Length>());
  }

  std::string_view text() {
    const ByteView bytes = block();
    return {reinterpret_cast<const char*>(bytes.data()), bytes.size()};
  }

 private:
  ByteView bytes_;
  std::size_t offset_{0};
  bool good_{true};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/layout.hpp"

#include "common/bytes/big_endian.hpp"
#include "waymark/layouts.hpp"

#include <algorithm>
#include <array>

namespace waymark {
namespace {

/// Moves `offset` past one string: int32 length with the terminating zero, then the bytes.
RejectReason walk_string(std::span<const std::uint8_t> body, std::size_t& offset) {
  if (body.size() - offset < 4) return RejectReason::kTruncated;
  const auto length = read_big_endian<std::int32_t>(&body[offset]);
  offset += 4;
  if (length < 1) return RejectReason::kBadLength;
  if (body.size() - offset < static_cast<std::size_t>(length)) return RejectReason::kTruncated;
  const auto text = body.subspan(offset, static_cast<std::size_t>(length));
  offset += text.size();
  // One zero, at the end: LCM's encoder treats strings as C strings.
  const bool is_c_string = std::ranges::find(text, 0) == text.end() - 1;
  return is_c_string ? RejectReason::kNone : RejectReason::kBadLength;
}

RejectReason walk_struct(std::span<const std::uint8_t> body, StructLayout layout,
                         std::size_t& offset);

RejectReason walk_field(std::span<const std::uint8_t> body, const FieldLayout& field,
                        std::int64_t count, std::size_t& offset) {
  if (count < 0) return RejectReason::kBadLength;
  if (field.kind == FieldLayout::Kind::kFixed) {
    const auto elements_left = static_cast<std::int64_t>(
        (body.size() - offset) / static_cast<std::size_t>(field.element_bytes));
    if (count > elements_left) return RejectReason::kTruncated;
    offset += static_cast<std::size_t>(count * field.element_bytes);
    return RejectReason::kNone;
  }
  for (std::int64_t i = 0; i < count; ++i) {
    const RejectReason reason = field.kind == FieldLayout::Kind::kString
                                    ? walk_string(body, offset)
                                    : walk_struct(body, field.struct_fields, offset);
    if (reason != RejectReason::kNone) return reason;
  }
  return RejectReason::kNone;
}

RejectReason walk_struct(std::span<const std::uint8_t> body, StructLayout layout,
                         std::size_t& offset) {
  std::array<std::int32_t, kMaxFields> int32_values{};
  for (std::size_t i = 0; i < layout.size(); ++i) {
    const FieldLayout& field = layout[i];
    const std::int64_t count = field.count_field < 0
                                   ? field.count
                                   : int32_values[static_cast<std::size_t>(field.count_field)];
    const std::size_t start = offset;
    const RejectReason reason = walk_field(body, field, count, offset);
    if (reason != RejectReason::kNone) return reason;
    if (field.kind == FieldLayout::Kind::kFixed && field.element_bytes == 4 && count == 1) {
      int32_values[i] = read_big_endian<std::int32_t>(&body[start]);
    }
  }
  return RejectReason::kNone;
}

}  // namespace

RejectReason walk(std::span<const std::uint8_t> body, StructLayout layout) {
  std::size_t offset = 0;
  const RejectReason reason = walk_struct(body, layout, offset);
  if (reason != RejectReason::kNone) return reason;
  return offset == body.size() ? RejectReason::kNone : RejectReason::kTrailingBytes;
}

StructLayout layout_of(std::int64_t fingerprint) {
  return layouts::of_all_types().at(fingerprint);
}

}  // namespace waymark

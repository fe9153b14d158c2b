// SPDX-License-Identifier: BSD-3-Clause
// The wire layout of our message types (made from lcmtypes/*.lcm), to check the length fields of a
// payload before it reaches the generated decoder, which throws, crashes or allocates gigabytes on
// hostile lengths (LCM 1.3.1).
#pragma once

#include "common/messages/reject_reason.hpp"

#include <cstddef>
#include <cstdint>
#include <span>

namespace waymark {

/// One field on the wire: `count` elements, or as many as the value of the earlier int32 field at
/// index `count_field`.
struct FieldLayout {
  enum class Kind { kFixed, kString, kStruct };

  Kind kind{Kind::kFixed};
  int element_bytes{0};  ///< kFixed only
  int count{1};
  int count_field{-1};                           ///< index in the same struct, or -1
  std::span<const FieldLayout> struct_fields{};  ///< kStruct only
};

inline constexpr std::size_t kMaxFields = 16;  ///< largest number of fields of a struct

using StructLayout = std::span<const FieldLayout>;

/// Walks the fields of a payload; checks every count against the bytes that are left. O(number of
/// fields and struct elements), no allocation.
/// @param body  the payload without its fingerprint.
/// @return kNone if the fields take exactly all bytes.
RejectReason walk(std::span<const std::uint8_t> body, StructLayout layout);

/// @param fingerprint  Type::getHash() of one of our message types.
/// @throws std::out_of_range for another one.
StructLayout layout_of(std::int64_t fingerprint);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Bytes <-> typed messages. decode() is the trust boundary: whatever the bytes are, it returns.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/message.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <string_view>

namespace waymark {

/// Why a message was not accepted.
enum class RejectReason {
  kNone,
  kTooLarge,
  kTruncated,  ///< shorter than its length fields say
  kWrongType,  ///< fingerprint of another type
  kBadLength,  ///< negative or absurd length field
  kTrailingBytes,
  kNotFinite,     ///< NaN or infinity where none may be
  kInconsistent,  ///< arrays that must agree in size do not, or a field has no such value
  kOutOfBounds,   ///< a number beyond bounds.hpp, which no robot has
  kBadTime,       ///< utime negative or absurdly far in the future
};

std::string_view to_string(RejectReason reason);

/// Result of decode(): a message, or the reason why there is none.
template <class Type>
struct Decoded {
  std::optional<Type> message{};
  RejectReason reason{RejectReason::kNone};
};

/// Fingerprint at the head of a payload; 0 when it is too short.
std::int64_t fingerprint_of(std::span<const std::uint8_t> payload);

/// utime of a payload (all our types start with it); nullopt when too short or out of range.
std::optional<Timestamp> time_of(std::span<const std::uint8_t> payload);

/// Size limit -> fingerprint -> walk of the length fields -> decode -> all bytes consumed ->
/// semantic check. Never throws, never allocates more than the payload's size allows.
template <class Type>
Decoded<Type> decode(std::span<const std::uint8_t> payload);

template <class Type>
Message encode(Channel<Type> channel, const Type& message);

}  // namespace waymark

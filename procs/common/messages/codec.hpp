// SPDX-License-Identifier: BSD-3-Clause
// Bytes <-> typed messages. decode() accepts arbitrary bytes from the network.
#pragma once

#include "common/messages/channels.hpp"
#include "common/messages/layout.hpp"
#include "common/messages/message.hpp"
#include "common/messages/reject_reason.hpp"
#include "common/messages/validate.hpp"

#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace waymark {

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

/// Checks of the bytes before decoding: size, fingerprint, length fields, and that the fields take
/// all bytes.
RejectReason check_bytes(std::span<const std::uint8_t> payload, std::int64_t fingerprint,
                         StructLayout layout);

/// check_bytes(), then the generated decoder, then the checks of time and values. Never throws,
/// never allocates more than the payload's size allows.
template <class Type>
Decoded<Type> decode(std::span<const std::uint8_t> payload) {
  static const StructLayout layout = layout_of(Type::getHash());
  const RejectReason bytes_fault = check_bytes(payload, Type::getHash(), layout);
  if (bytes_fault != RejectReason::kNone) return {{}, bytes_fault};
  Type message{};
  const int size = static_cast<int>(payload.size());
  if (message.decode(payload.data(), 0, size) != size) return {{}, RejectReason::kTruncated};
  if (!time_of(payload)) return {{}, RejectReason::kBadTime};
  const RejectReason fault = validate(message);
  if (fault != RejectReason::kNone) return {{}, fault};
  return {std::move(message), RejectReason::kNone};
}

/// @throws std::logic_error  when the message is not valid.
template <class Type>
Message encode(Channel<Type> channel, const Type& message) {
  const RejectReason fault = validate(message);
  if (fault != RejectReason::kNone) {
    throw std::logic_error{"a message for " + std::string{channel.name} + " is " +
                           std::string{to_string(fault)} + " (utime " +
                           std::to_string(message.utime) + ")"};
  }
  Message encoded{std::string{channel.name}, timestamp_from_us(message.utime), {}};
  encoded.payload.resize(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(encoded.payload.data(), 0, static_cast<int>(encoded.payload.size()));
  return encoded;
}

}  // namespace waymark

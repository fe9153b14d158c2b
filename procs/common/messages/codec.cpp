// SPDX-License-Identifier: BSD-3-Clause
#include "common/messages/codec.hpp"

#include "common/bytes/big_endian.hpp"
#include "common/messages/bounds.hpp"

#include <cstring>

namespace waymark {
namespace {

constexpr std::size_t kFingerprintBytes = 8;
constexpr std::size_t kMaxDecodedBytes = std::size_t{16}
                                         << 20;  // logs of other robots hold raw images

/// One step of a 64-bit multiplicative hash.
std::uint64_t mix(std::uint64_t hash, std::uint64_t word) {
  hash = (hash ^ word) * 0x9e3779b97f4a7c15ULL;
  return hash ^ (hash >> 29);
}

bool is_sane_time(std::int64_t utime_us) {
  return utime_us >= 0 && utime_us <= bounds::kTime_us;
}

}  // namespace

std::string_view to_string(RejectReason reason) {
  switch (reason) {
    case RejectReason::kNone:
      return "none";
    case RejectReason::kTooLarge:
      return "too large";
    case RejectReason::kTruncated:
      return "truncated";
    case RejectReason::kWrongType:
      return "wrong type";
    case RejectReason::kBadLength:
      return "bad length";
    case RejectReason::kTrailingBytes:
      return "trailing bytes";
    case RejectReason::kNotFinite:
      return "not finite";
    case RejectReason::kInconsistent:
      return "inconsistent";
    case RejectReason::kOutOfBounds:
      return "out of bounds";
    case RejectReason::kBadTime:
      return "bad time";
  }
  return "unknown";
}

std::int64_t content_hash(const Message& message) {
  std::uint64_t hash = message.payload.size();
  for (const char c : message.channel)
    hash = mix(hash, static_cast<std::uint8_t>(c));
  std::size_t offset = 0;
  for (; offset + 8 <= message.payload.size(); offset += 8) {
    std::uint64_t word = 0;
    std::memcpy(&word, &message.payload[offset], 8);
    hash = mix(hash, word);
  }
  for (; offset < message.payload.size(); ++offset)
    hash = mix(hash, message.payload[offset]);
  return static_cast<std::int64_t>(hash);
}

std::int64_t fingerprint_of(std::span<const std::uint8_t> payload) {
  return payload.size() < kFingerprintBytes ? 0 : read_big_endian<std::int64_t>(payload.data());
}

std::optional<Timestamp> time_of(std::span<const std::uint8_t> payload) {
  if (payload.size() < 2 * kFingerprintBytes) return std::nullopt;
  const auto utime_us = read_big_endian<std::int64_t>(&payload[kFingerprintBytes]);
  if (!is_sane_time(utime_us)) return std::nullopt;
  return timestamp_from_us(utime_us);
}

RejectReason check_bytes(std::span<const std::uint8_t> payload, std::int64_t fingerprint,
                         StructLayout layout) {
  if (payload.size() > kMaxDecodedBytes) return RejectReason::kTooLarge;
  if (payload.size() < kFingerprintBytes) return RejectReason::kTruncated;
  if (fingerprint_of(payload) != fingerprint) return RejectReason::kWrongType;
  return walk(payload.subspan(kFingerprintBytes), layout);
}

}  // namespace waymark

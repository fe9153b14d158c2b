// SPDX-License-Identifier: BSD-3-Clause
// A message as it travels: bytes with a channel name and a time.
#pragma once

#include "common/time/time.hpp"

#include <cstdint>
#include <string>
#include <vector>

namespace waymark {

/// Payloads up to this fit one UDP datagram (65 507 bytes) together with LCM's header.
constexpr std::size_t kMaxPayloadBytes = 65000;

struct Message {
  std::string channel{};
  Timestamp time{};  ///< the payload's utime
  std::vector<std::uint8_t> payload{};

  bool operator==(const Message&) const = default;
};

/// Order in which the messages of a tick are processed and recorded: total, independent of arrival.
inline bool comes_before(const Message& a, const Message& b) {
  if (a.time != b.time) return a.time < b.time;
  if (a.channel != b.channel) return a.channel < b.channel;
  return a.payload < b.payload;
}

/// 64-bit hash of channel and payload: identifies a message; no protection against forgery.
std::int64_t content_hash(const Message& message);

}  // namespace waymark

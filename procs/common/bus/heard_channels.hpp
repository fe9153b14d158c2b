// SPDX-License-Identifier: BSD-3-Clause
// What has come on a network, wanted or not.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

namespace waymark {

/// The messages of one channel, by the wall clock.
struct HeardChannel {
  using Time = std::chrono::steady_clock::time_point;

  Time first{};
  Time last{};
  std::int64_t count{0};
};

/// By the channel's name on the network.
using HeardChannels = std::map<std::string, HeardChannel, std::less<>>;

/// Notes a message. Names that cannot be printed are left out, and so are further ones of a sender
/// that invents them, so that memory is bounded.
void note_heard(HeardChannels& heard, std::string_view name, HeardChannel::Time now);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Input: a datagram from the network.
#include "common/bus/datagram_receiver.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto message = waymark::whole_message_in({data, size});
  if (!message) return 0;
  // The bytes before the payload are magic, sequence number, and channel with its zero.
  const std::size_t rest = 8 + message->channel.size() + 1;
  if (rest + message->payload.size() != size || message->channel.empty()) std::abort();
  if (message->channel.find('\0') != std::string_view::npos) std::abort();
  return 0;
}

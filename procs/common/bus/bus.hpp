// SPDX-License-Identifier: BSD-3-Clause
// The network: the only code that includes LCM.
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/bus/heard_channels.hpp"
#include "common/messages/message.hpp"
#include "common/node/node.hpp"

#include <chrono>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

/// Messages of several datagrams: we send none, but a robot's camera driver may.
enum class LargeMessages {
  kRefused,
  kAccepted,  ///< up to 4 MiB; liblcm receives, and forged fragments can crash version 1.3.1
};

/// Which publishers are accepted. Statuses and commands are accepted from all.
enum class Publishers {
  kAny,            ///< for lockstep, where each TICK lists the messages that belong to it
  kOnePerChannel,  ///< see ChannelOwners; without effect except on udpm without large messages
};

/// `--lcm-url`, else $LCM_DEFAULT_URL, else the loopback default.
std::string lcm_url_or_default(const std::string& given_url);

/// The URL, with a request for a receive buffer that holds several large messages, unless it has
/// one. The kernel grants no more than net.core.rmem_max.
std::string with_large_buffer(const std::string& lcm_url);

/// Checks that the network can be used, by joining and leaving it.
/// @throws SetupError as Bus does.
void check_network(const std::string& url);

/// Messages in and out over one LCM instance.
///
/// A receiver thread empties LCM's queues (which drop the newest message when full), rejects
/// messages of impossible size or time, and keeps a bounded queue per channel. On UDP multicast
/// without large messages, DatagramReceiver receives instead of liblcm: only messages that fit one
/// datagram. Messages are not decoded here, and no exception passes through LCM's C frames.
/// Message::channel is Waymark's name; the network uses the names of section [channels].
class Bus {
 public:
  /// @throws SetupError when there is no multicast route or the URL is invalid; it says what to do.
  Bus(const std::string& url, const std::vector<Inbox::Subscription>& subscriptions,
      LargeMessages large_messages = LargeMessages::kRefused, const ChannelNames& names = {},
      Publishers publishers = Publishers::kAny);
  ~Bus();
  Bus(const Bus&) = delete;
  Bus& operator=(const Bus&) = delete;

  /// Oldest queued message, waiting for one up to `timeout`.
  std::optional<Message> receive(std::chrono::milliseconds timeout);

  /// @throws std::logic_error when the payload does not fit one datagram, or the channel has no
  /// name on the network (ChannelNames::uses()).
  void publish(const Message& message);

  /// All channels that have come, also those without a subscription; only those with one where
  /// liblcm receives. Large messages are left out unless they are accepted.
  HeardChannels heard() const;

  /// Adds to `counters` the numbers of messages refused or dropped since the last call.
  void collect_counts(Counters& counters);

 private:
  class Implementation;
  std::unique_ptr<Implementation> implementation_;
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// LCM's datagrams as they come from the network, with their senders.
#pragma once

#include <chrono>
#include <compare>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Socket that a datagram came from: each publishing process has its own.
struct Sender {
  std::uint32_t address{0};  ///< IPv4, in host byte order
  std::uint16_t port{0};

  auto operator<=>(const Sender&) const = default;
};

/// "127.0.0.1:40000".
std::string to_string(const Sender& sender);

struct MulticastGroup {
  std::uint32_t address{0};  ///< IPv4, in host byte order
  std::uint16_t port{0};
};

/// The group of udpm://ADDRESS:PORT?..., with LCM's defaults for what is missing; nullopt when the
/// URL is of another kind of network.
/// @throws SetupError when address or port is invalid.
std::optional<MulticastGroup> multicast_group_of(const std::string& lcm_url);

/// A message in one datagram. Source: lcm_udpm.c, "short message".
struct WholeMessage {
  std::string_view channel{};
  std::span<const std::uint8_t> payload{};
};

/// The message as views of the datagram's bytes; nullopt if they are not one whole LCM message.
std::optional<WholeMessage> whole_message_in(std::span<const std::uint8_t> datagram);

/// Whether the datagram is a part of a message larger than one datagram. Source: lcm_udpm.c.
bool is_fragment(std::span<const std::uint8_t> datagram);

/// Receives the messages of a multicast group that fit one datagram.
///
/// Replaces liblcm's receiver, which does not report the sender. The receiver of liblcm 1.3.1 also
/// reassembles fragments without checking their offsets: two forged datagrams make it write outside
/// of its buffer. None of our messages needs fragments.
class DatagramReceiver {
 public:
  struct Received {
    Sender sender{};
    WholeMessage message{};  ///< valid until the next receive()
  };

  /// @throws std::system_error when the group cannot be joined.
  explicit DatagramReceiver(const MulticastGroup& group);
  ~DatagramReceiver();
  DatagramReceiver(const DatagramReceiver&) = delete;
  DatagramReceiver& operator=(const DatagramReceiver&) = delete;

  /// The message in the next datagram; nullopt when it holds no whole message, or none comes within
  /// kWait.
  std::optional<Received> receive();

  /// Datagrams since the last call that were neither a message nor a fragment.
  std::int64_t take_malformed();

  /// Datagrams since the last call that were fragments of large messages.
  std::int64_t take_fragments();

  /// Datagrams since the last call that the kernel dropped because the socket's queue was full.
  std::int64_t take_overflowed();

 private:
  static constexpr std::chrono::milliseconds kWait{50};

  void join(const MulticastGroup& group) const;

  int socket_{-1};
  std::vector<std::uint8_t> bytes_{};
  std::int64_t malformed_{0};
  std::int64_t fragments_{0};
  std::uint32_t overflowed_before_{0};  ///< the kernel's count at the last call; wraps around
};

}  // namespace waymark

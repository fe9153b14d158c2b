// SPDX-License-Identifier: BSD-3-Clause
// A private LCM network for a test: a UDP port that no other test of this machine uses now.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace waymark::testing_support {

/// Holds a lock on the port for the lifetime of the object.
class PrivateNetwork {
 public:
  /// @throws std::runtime_error when no port is free.
  PrivateNetwork();
  ~PrivateNetwork();
  PrivateNetwork(const PrivateNetwork&) = delete;
  PrivateNetwork& operator=(const PrivateNetwork&) = delete;

  std::string url() const;

  int port() const { return port_; }

  /// Sends raw bytes as one datagram to the network, without LCM.
  void send_datagram(const std::vector<std::uint8_t>& bytes) const;

 private:
  int port_{0};
  int lock_file_{-1};
  int socket_file_{-1};  ///< one for all datagrams, as LCM reassembles fragments by sender
};

/// LCM's small-message datagram: magic, sequence number, channel with its zero, payload.
std::vector<std::uint8_t> lcm_datagram(const std::string& channel,
                                       const std::vector<std::uint8_t>& payload);

/// One fragment of a large message as LCM sends it.
std::vector<std::uint8_t> lcm_fragment(std::uint32_t message_bytes, std::uint32_t offset,
                                       std::uint16_t fragment, std::uint16_t num_fragments,
                                       const std::vector<std::uint8_t>& body);

}  // namespace waymark::testing_support

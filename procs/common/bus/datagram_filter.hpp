// SPDX-License-Identifier: BSD-3-Clause
// Keeps from liblcm what it cannot bear.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace waymark {

/// A filter in the kernel on LCM's receiving sockets: only whole messages of one datagram pass.
///
/// liblcm 1.3.1 puts large messages together from fragments without checking their offsets: two
/// forged datagrams make it write outside of its buffer. None of our messages needs fragments, so
/// they are dropped before liblcm sees a byte. Source: socket(7), SO_ATTACH_FILTER; lcm_udpm.c.
class DatagramFilter {
 public:
  /// Attaches to the UDP sockets of this process that are bound to the port of the URL; does
  /// nothing for networks that are not udpm. Call after the first subscription, when they are
  /// there.
  /// @throws std::system_error if the kernel refuses.
  explicit DatagramFilter(const std::string& lcm_url);

  /// Datagrams that the kernel has dropped since the last call: refused here, or the socket's
  /// buffer was full.
  std::int64_t take_dropped();

 private:
  struct Socket {
    int file{-1};  ///< liblcm's own
    std::uint32_t dropped{0};
  };

  std::vector<Socket> sockets_{};
};

}  // namespace waymark

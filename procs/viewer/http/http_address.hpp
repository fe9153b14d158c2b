// SPDX-License-Identifier: BSD-3-Clause
// HOST:PORT, as --http takes it.
#pragma once

#include <string>
#include <string_view>

namespace waymark::viewer {

struct HttpAddress {
  std::string host{};  ///< a name or an address; IPv6 without its brackets
  int port{0};         ///< 1..65535

  /// Only programs on this machine can connect.
  bool is_loopback() const;
  std::string url() const;
};

/// "HOST:PORT", ":PORT" (this machine only) or "[IPv6]:PORT".
/// @throws SetupError for anything else.
HttpAddress parse_http_address(std::string_view text);

/// Whether a Host header ("name" or "name:port") names this machine. A page of another site that
/// reaches us by a name of its own (DNS rebinding) does not.
bool names_loopback(std::string_view host_header);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// HOST:PORT of option --http.
#pragma once

#include <string>
#include <string_view>

namespace waymark::viewer {

struct HttpAddress {
  std::string host{};  ///< a name or an address; IPv6 without its brackets
  int port{0};         ///< 1..65535

  /// True when only programs on this machine can connect.
  bool is_loopback() const;
  std::string url() const;
};

/// "HOST:PORT", ":PORT" (this machine only) or "[IPv6]:PORT".
/// @throws SetupError for anything else.
HttpAddress parse_http_address(std::string_view text);

/// True when a Host header ("name" or "name:port") names this machine. Rejecting others prevents
/// DNS rebinding: another site's page that reaches this server by its own domain name.
bool names_loopback(std::string_view host_header);

}  // namespace waymark::viewer

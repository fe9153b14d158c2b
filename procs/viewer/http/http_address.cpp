// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/http/http_address.hpp"

#include "common/errors/setup_error.hpp"

#include <fmt/format.h>

#include <charconv>

namespace waymark::viewer {
namespace {

constexpr std::string_view kLoopback = "127.0.0.1";

/// Not every name that begins like an address is one: 127.0.0.1.example.org is another machine.
bool is_loopback_name(std::string_view host) {
  const bool is_number = host.find_first_not_of("0123456789.") == std::string_view::npos;
  return host == "localhost" || host == "::1" || (is_number && host.starts_with("127."));
}

bool is_host(std::string_view host, bool in_brackets) {
  constexpr std::string_view kAllowed =
      "abcdefghijklmnopqrstuvwxyzABCDEFGHIJKLMNOPQRSTUVWXYZ0123456789.-_";
  const std::string_view colon = in_brackets ? ":" : "";
  for (const char c : host) {
    if (kAllowed.find(c) == std::string_view::npos && colon.find(c) == std::string_view::npos)
      return false;
  }
  return !host.empty();
}

int parse_port(std::string_view text) {
  int port = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), port);
  const bool is_whole = error == std::errc{} && end == text.data() + text.size();
  return is_whole && port >= 1 && port <= 65535 ? port : 0;
}

}  // namespace

bool HttpAddress::is_loopback() const {
  return is_loopback_name(host);
}

std::string HttpAddress::url() const {
  const bool is_ipv6 = host.find(':') != std::string::npos;
  return is_ipv6 ? fmt::format("http://[{}]:{}/", host, port)
                 : fmt::format("http://{}:{}/", host, port);
}

HttpAddress parse_http_address(std::string_view text) {
  const std::size_t colon = text.rfind(':');
  std::string_view host = colon == std::string_view::npos ? text : text.substr(0, colon);
  const bool in_brackets = host.size() > 2 && host.front() == '[' && host.back() == ']';
  if (in_brackets) host = host.substr(1, host.size() - 2);
  if (host.empty()) host = kLoopback;
  const int port = colon == std::string_view::npos ? 0 : parse_port(text.substr(colon + 1));
  if (port == 0 || !is_host(host, in_brackets)) {
    throw SetupError{fmt::format(
        "--http: got '{}', expected HOST:PORT with a port from 1 to 65535, e.g. 127.0.0.1:8080",
        text)};
  }
  return {.host = std::string{host}, .port = port};
}

bool names_loopback(std::string_view host_header) {
  std::string_view host = host_header;
  if (host.starts_with('[')) {
    host = host.substr(1, host.find(']') - 1);
  } else {
    host = host.substr(0, host.find(':'));
  }
  return is_loopback_name(host);
}

}  // namespace waymark::viewer

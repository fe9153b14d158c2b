// SPDX-License-Identifier: BSD-3-Clause
// Input: a byte that selects the kind, then a part of a browser's request: the JSON of a command, a
// Host header, or an Authorization header. A command that the page accepts can be sent to slam,
// which accepts or refuses it.
#include "common/messages/codec.hpp"
#include "slam/command_desk.hpp"
#include "viewer/http/http_address.hpp"
#include "viewer/http/page_commands.hpp"

#include <cctype>
#include <cstdlib>

namespace waymark::fuzz {
namespace {

constexpr std::string_view kToken = "0123456789abcdef";

void check_command(std::string_view json) {
  try {
    const command_t command = viewer::parse_page_command(json);
    const Message message = encode(channels::kSlamCommand, command);
    const auto received = decode<command_t>(message.payload).message;
    if (!received || received->name != command.name) std::abort();
    checked(*received);
  } catch (const std::invalid_argument&) {
  } catch (const Refusal&) {
  }
}

/// A host name with letters names this machine only if it is "localhost" or an IPv6 address in
/// brackets.
void check_host(std::string_view host) {
  if (!viewer::names_loopback(host) || host == "localhost" || host.starts_with("localhost:") ||
      host.starts_with("[localhost") || host.starts_with("[::1"))
    return;
  for (const char c : host.substr(0, host.find_first_of(":]")))
    if (std::isalpha(static_cast<unsigned char>(c)) != 0) std::abort();
}

void check_authorization(std::string_view header) {
  if (viewer::carries_token(header, kToken) != (header == "Bearer " + std::string{kToken}))
    std::abort();
}

}  // namespace
}  // namespace waymark::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark::fuzz;
  if (size == 0) return 0;
  const std::string_view text{reinterpret_cast<const char*>(data + 1), size - 1};
  switch (data[0] % 4) {
    case 0:
      check_host(text);
      break;
    case 1:
      check_authorization(text);
      break;
    default:
      check_command(text);
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Commands of the page to slam, and their authorisation.
#pragma once

#include "common/messages/channels.hpp"

#include <functional>
#include <optional>
#include <string>
#include <string_view>

namespace waymark::viewer {

struct PageCommands {
  std::string token{};  ///< the secret that authorises commands
  std::function<std::optional<reply_t>(const command_t&)> ask{};  ///< nullopt: no answer came
};

/// The value of --http-token: the token itself, or @FILE, whose first line it is.
/// @throws SetupError when it is not 16 to 200 printable characters without spaces.
std::string parse_http_token(const std::string& text);

/// True when an Authorization header is "Bearer " and the token. Constant time for tokens of equal
/// length.
bool carries_token(std::string_view authorization_header, std::string_view token);

/// A command as the page sends it, JSON: {"command": "save", "name": NAME}, {"command": "reset"},
/// {"command": "set-pose", "pose": [x_m, y_m, yaw_rad], "sigmas": [m, rad]} (sigmas may be left
/// out), {"command": "set-mode", "mode": "map" | "localise" | "extend"}.
/// @throws std::invalid_argument with a sentence for anything else.
command_t parse_page_command(std::string_view json);

}  // namespace waymark::viewer

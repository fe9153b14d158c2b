// SPDX-License-Identifier: BSD-3-Clause
// The command line of waymark-command as a message.
#pragma once

#include "common/messages/channels.hpp"

#include <optional>
#include <string>

namespace waymark {

struct CommandLine {
  command_t command{};
  std::string lcm_url{};
  std::string channels_file{};     ///< empty = Waymark's names
  std::optional<int> exit_code{};  ///< set when there is nothing to send: --help, wrong usage
};

CommandLine parse_command_line(int argc, const char* const* argv);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// One SLAM_COMMAND, and the SLAM_REPLY to it.
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/messages/channels.hpp"

#include <cstdint>
#include <map>
#include <optional>
#include <string>

namespace waymark {

/// Standard deviations of a pose that a person has set by pointing at a map.
inline constexpr double kPointedSigma_m = 0.1;
inline constexpr double kPointedSigma_rad = 0.1;

/// command_t::MODE_* by name: "map", "localise", "extend".
const std::map<std::string, std::int8_t>& command_modes();

/// Gives the command a unique id and re-sends it until slam answers; slam executes it once.
/// @return nullopt when no answer comes within 2 s.
/// @throws SetupError as Bus does.
std::optional<reply_t> ask_slam(const std::string& lcm_url, const ChannelNames& names,
                                command_t command);

}  // namespace waymark

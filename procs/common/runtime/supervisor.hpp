// SPDX-License-Identifier: BSD-3-Clause
// Notifications to the supervisor that has started the process (systemd, units of Type=notify).
#pragma once

#include <string_view>

namespace waymark {

/// States of sd_notify(3).
inline constexpr std::string_view kReady = "READY=1";
inline constexpr std::string_view kAlive = "WATCHDOG=1";
inline constexpr std::string_view kStopping = "STOPPING=1";

/// Sends the state as a datagram to the socket in $NOTIFY_SOCKET. Does nothing where there is no
/// supervisor, or it does not listen.
void notify_supervisor(std::string_view state);

}  // namespace waymark

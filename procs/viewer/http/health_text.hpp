// SPDX-License-Identifier: BSD-3-Clause
// The state of the localisation in words: what it is, and what it rests on.
#pragma once

#include "viewer/http/live_view.hpp"

#include <string>
#include <string_view>

namespace waymark::viewer {

/// "tracking", "degenerate", ...: the names of HEALTH_* in lcmtypes/slam_estimate_t.lcm.
std::string_view health_name(Health health);

/// The same, or "waiting" where slam has not said anything yet.
std::string_view health_name(const LiveView& view);

std::string_view source_name(WeakAxisSource source);

/// One to three sentences for people.
std::string health_reason(const LiveView& view);

/// [s] of message time since then, not below zero.
std::optional<double> seconds_since(const std::optional<Timestamp>& then, Timestamp now);

}  // namespace waymark::viewer

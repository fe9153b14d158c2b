// SPDX-License-Identifier: BSD-3-Clause
// The state of the localisation in sentences, with its reason.
#pragma once

#include "viewer/http/live_view.hpp"

#include <string>
#include <string_view>

namespace waymark::viewer {

/// "tracking", "degenerate", ...; "waiting" before the first message of slam; "silent" when slam
/// has sent no estimate for 2 s.
std::string_view health_name(const LiveView& view);

std::string_view source_name(WeakAxisSource source);

/// One to three sentences that explain the health.
std::string health_reason(const LiveView& view);

/// Message time since `then` [s], not below 0; nullopt without `then`.
std::optional<double> seconds_since(const std::optional<Timestamp>& then, Timestamp now);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// A node on logs instead of the network: in order, nothing lost, as fast as it can.
#pragma once

#include "common/node/node.hpp"
#include "common/runtime/options.hpp"

namespace waymark {

/// @return exit code: 1 when a log held bytes that are not events or nothing for this process, or
/// messages were refused.
int run_replay(const ProcessOptions& options, Node& node, Inbox& inbox, Outbox& outbox);

}  // namespace waymark

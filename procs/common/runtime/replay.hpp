// SPDX-License-Identifier: BSD-3-Clause
// Runs a node on logs instead of the network: in order, without loss, as fast as it can.
#pragma once

#include "common/node/node.hpp"
#include "common/runtime/options.hpp"

namespace waymark {

/// @return exit code: 1 when a log has bytes that are not events, or no channel that this process
/// reads, when messages were rejected, or when the node failed.
int run_replay(const ProcessOptions& options, Node& node, Inbox& inbox, Outbox& outbox);

}  // namespace waymark

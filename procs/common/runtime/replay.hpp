// SPDX-License-Identifier: BSD-3-Clause
// Runs a node on logs instead of the network: in order, without loss, as fast as it can.
#pragma once

#include "common/node/node.hpp"
#include "common/runtime/options.hpp"

namespace waymark {

/// Prints the names of the channels that occur in the logs, sorted, one in a line.
/// @throws SetupError for a log that cannot be read.
void print_channels(const std::vector<std::filesystem::path>& logs);

/// Replays the logs of the options through the node.
/// @return exit code. 1: a log has bytes that are not events, or no event; no log has any of the
/// channels that this process reads; a channel that the node needs is in no log; nothing is left
/// between --skip-s and --until-s; messages were rejected; or the node failed. 128 + n: ended by
/// signal n.
/// @throws SetupError when a log cannot be opened.
int run_replay(const ProcessOptions& options, Node& node, Inbox& inbox, Outbox& outbox);

}  // namespace waymark

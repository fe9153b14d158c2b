// SPDX-License-Identifier: BSD-3-Clause
// main() of every process but the simulator: command line, configuration, and one of three sources
// of messages (lockstep, real time, logs) for the same node.
#pragma once

#include "common/config/config.hpp"
#include "common/node/node.hpp"
#include "common/runtime/options.hpp"

#include <functional>
#include <memory>
#include <string>

namespace waymark {

/// A node type without its template.
struct ProcessDescription {
  ProcessTraits traits{};
  OptionSet option_set{};
  std::function<std::string(const ProcessOptions&)> dump_config{};
  std::function<std::string(const ProcessOptions&, const std::string& key)> config_value{};
  std::function<std::unique_ptr<Node>(const ProcessOptions&, Inbox&, Outbox&)> make_node{};
};

int run_described_process(int argc, char** argv, const ProcessDescription& description);

/// Configuration from files and command line, with --out, --out-log and --http where the struct has
/// members for them.
template <class Config>
Config config_from(const ProcessOptions& options) {
  Config config = load_config<Config>(options.config_sources);
  if constexpr (requires { config.out_dir; }) config.out_dir = options.out_dir;
  if constexpr (requires { config.out_log; }) config.out_log = options.out_log;
  if constexpr (requires { config.http; }) config.http = options.http;
  if constexpr (requires { config.load_map; }) config.load_map = options.load_map;
  if constexpr (requires { config.save_map; }) config.save_map = options.save_map;
  if constexpr (requires { config.is_replay; }) config.is_replay = !options.logs.empty();
  return config;
}

template <class NodeType>
int run_process(int argc, char** argv) {
  using Config = typename NodeType::Config;
  constexpr bool kWritesFolder = requires(Config c) {
    c.out_dir;
  };
  constexpr bool kIsRecorder = requires(Config c) {
    c.out_log;
  };
  constexpr bool kServesPage = requires(Config c) {
    c.http;
  };
  constexpr bool kHasMaps = requires(Config c) {
    c.save_map;
  };
  ProcessDescription description;
  description.traits = NodeType::kTraits;
  description.option_set = {.log = !kIsRecorder,
                            .out_log = !kWritesFolder,
                            .out_dir = kWritesFolder,
                            .http = kServesPage,
                            .maps = kHasMaps};
  description.dump_config = [](const ProcessOptions& options) {
    return dump_config(config_from<Config>(options));
  };
  description.config_value = [](const ProcessOptions& options, const std::string& key) {
    return config_value(config_from<Config>(options), key);
  };
  description.make_node = [](const ProcessOptions& options, Inbox& inbox, Outbox& outbox) {
    return std::make_unique<NodeType>(config_from<Config>(options), inbox, outbox);
  };
  return run_described_process(argc, argv, description);
}

}  // namespace waymark

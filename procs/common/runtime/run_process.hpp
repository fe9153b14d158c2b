// SPDX-License-Identifier: BSD-3-Clause
// main() of every process but the simulator: command line, configuration, and one of three sources
// of messages (lockstep, real time, logs) for the same node.
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/config/config.hpp"
#include "common/node/node.hpp"
#include "common/runtime/options.hpp"

#include <functional>
#include <memory>
#include <string>

namespace waymark {

/// The configuration of a program by its options, type-erased.
struct ConfigAccess {
  std::function<std::string(const ProcessOptions&)> dump{};
  std::function<std::string(const ProcessOptions&, const std::string& key)> value{};
  std::function<ChannelNames(const ProcessOptions&)> channel_names{[](const ProcessOptions&) {
    return ChannelNames{};
  }};
};

/// A node type and its configuration, type-erased, so that run_described_process() is no template.
struct ProcessDescription {
  ProcessTraits traits{};
  OptionSet option_set{};
  ConfigAccess config{};
  std::function<void(const ProcessOptions&)> check_node{};  ///< the node's own part of --check
  std::function<std::unique_ptr<Node>(const ProcessOptions&, Inbox&, Outbox&)> make_node{};
};

/// A program's own configuration, and section [channels], which every program has.
template <class Config>
struct ProcessConfig {
  Config own{};
  ChannelNames channels{};

  void describe(Fields& fields) {
    own.describe(fields);
    fields.section("channels", channels);
  }

  void check(Problems& problems) const {
    if constexpr (requires { own.check(problems); }) own.check(problems);
    channels.check(problems);
  }
};

int run_described_process(int argc, char** argv, const ProcessDescription& description);

/// Configuration from files and command line. Options such as --out or --http, and the names of
/// channels, are copied into it where the struct has a member for them.
template <class Config>
ProcessConfig<Config> process_config_from(const ProcessOptions& options) {
  auto loaded = load_config<ProcessConfig<Config>>(options.config_sources);
  Config& config = loaded.own;
  if constexpr (requires { config.channels; }) config.channels = loaded.channels;
  if constexpr (requires { config.out_dir; }) config.out_dir = options.out_dir;
  if constexpr (requires { config.out_log; }) config.out_log = options.out_log;
  if constexpr (requires { config.http; }) config.http = options.http;
  if constexpr (requires { config.http_token; }) config.http_token = options.http_token;
  if constexpr (requires { config.lcm_url; }) config.lcm_url = options.lcm_url;
  if constexpr (requires { config.load_map; }) config.load_map = options.load_map;
  if constexpr (requires { config.save_map; }) config.save_map = options.save_map;
  if constexpr (requires { config.is_replay; }) config.is_replay = !options.logs.empty();
  return loaded;
}

/// @param load  reads the whole configuration.
template <class Config>
ConfigAccess config_access(ProcessConfig<Config> (*load)(const ProcessOptions&)) {
  return {.dump = [load](const auto& options) { return dump_config(load(options)); },
          .value = [load](const auto& options,
                          const auto& key) { return config_value(load(options), key); },
          .channel_names =
              [load](const auto& options) {
                return load(options).channels;
              }};
}

template <class NodeType>
ProcessDescription describe_process() {
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
  description.option_set = {.large_messages = true,
                            .for_s = kIsRecorder,
                            .log = !kIsRecorder,
                            .out_log = !kWritesFolder,
                            .out_dir = kWritesFolder,
                            .http = kServesPage,
                            .maps = kHasMaps};
  description.config = config_access(process_config_from<Config>);
  description.check_node = [](const ProcessOptions& options) {
    if constexpr (requires(const Config& c) { NodeType::check(c); })
      NodeType::check(process_config_from<Config>(options).own);
  };
  description.make_node = [](const ProcessOptions& options, Inbox& inbox, Outbox& outbox) {
    return std::make_unique<NodeType>(process_config_from<Config>(options).own, inbox, outbox);
  };
  return description;
}

template <class NodeType>
int run_process(int argc, char** argv) {
  return run_described_process(argc, argv, describe_process<NodeType>());
}

}  // namespace waymark

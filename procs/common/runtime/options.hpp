// SPDX-License-Identifier: BSD-3-Clause
// The command line that all processes share.
#pragma once

#include "common/config/config.hpp"
#include "common/node/node.hpp"

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <vector>

namespace waymark {

struct ProcessOptions {
  ConfigSources config_sources{};
  bool dump_config{false};
  bool dump_robot_config{false};
  std::string print_config{};  ///< the key to print; empty = none
  bool check{false};
  bool print_channels{false};
  std::string lcm_url{};
  bool real_time{false};
  bool large_messages{false};
  std::optional<double> for_s{};  ///< wall-clock time after which the process ends by itself
  std::vector<std::filesystem::path> logs{};
  double skip_s{0.0};               ///< from the first message of the logs
  std::optional<double> until_s{};  ///< from the first message of the logs; nullopt = to their end
  std::filesystem::path out_log{};
  std::filesystem::path out_dir{};
  std::filesystem::path report{};
  std::string http{};
  std::string http_token{};
  std::filesystem::path load_map{};
  std::filesystem::path save_map{};
  std::optional<std::int64_t> seed{};
};

/// Input files that the options name: logs, configuration files, and the map to load.
std::vector<std::filesystem::path> inputs_of(const ProcessOptions& options);

/// Which of the optional options a process has.
struct OptionSet {
  bool large_messages{false};
  bool for_s{false};
  bool log{false};
  bool out_log{false};
  bool out_dir{false};
  bool http{false};
  bool maps{false};
  bool seed{false};
  bool dump_robot_config{false};
};

struct ParsedOptions {
  ProcessOptions options{};
  std::optional<int> exit_code{};  ///< set after --help, --version and wrong usage
};

ParsedOptions parse_options(int argc, char** argv, const ProcessTraits& traits,
                            const OptionSet& option_set);

/// @throws SetupError for an option that would have no effect or overwrite an input, and for a
/// --save-map that cannot be written.
void check_options(const ProcessOptions& options, const OptionSet& option_set);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Input: a byte that selects a program, then the words of its command line, each ended by a zero
// byte. The program must refuse it, or accept only values that the options allow and that can be
// printed and read back. No file is opened (only checked for existence) and no network joined.
#include "command/command_line.hpp"

#include "common/bus/bus.hpp"
#include "common/bus/datagram_receiver.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"
#include "common/runtime/run_simulator.hpp"
#include "detector/detector_node.hpp"
#include "memory_file.hpp"
#include "recorder/recorder_node.hpp"
#include "sim/sim_node.hpp"
#include "slam/slam_node.hpp"
#include "viewer/viewer_node.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <iostream>

namespace waymark::fuzz {
namespace {

constexpr std::size_t kMaxWords = 64;

/// argc and argv; owns the words.
class Arguments {
 public:
  explicit Arguments(std::span<const std::uint8_t> bytes) {
    words_.emplace_back("program");
    while (!bytes.empty() && words_.size() < kMaxWords) {
      const auto end = std::ranges::find(bytes, std::uint8_t{0});
      words_.emplace_back(bytes.begin(), end);
      bytes = bytes.subspan(std::min<std::size_t>(words_.back().size() + 1, bytes.size()));
    }
    for (std::string& word : words_)
      pointers_.push_back(word.data());
    pointers_.push_back(nullptr);
  }

  int count() const { return static_cast<int>(words_.size()); }

  char** pointers() { return pointers_.data(); }

 private:
  std::vector<std::string> words_{};
  std::vector<char*> pointers_{};
};

void require(bool holds) {
  if (!holds) std::abort();
}

/// False if the action throws ConfigError or SetupError; any other exception is a bug.
template <class Action>
bool is_allowed(Action action) {
  try {
    action();
    return true;
  } catch (const ConfigError&) {
  } catch (const SetupError&) {
  }
  return false;
}

void check_numbers(const ProcessOptions& options) {
  require(std::isfinite(options.skip_s) && options.skip_s >= 0.0);
  require(!options.until_s || (std::isfinite(*options.until_s) && *options.until_s > 0.0));
}

void check_page(const ProcessOptions& options) {
  is_allowed([&] {
    const viewer::HttpAddress address = viewer::parse_http_address(options.http);
    require(address.port >= 1 && address.port <= 65535 && !address.host.empty());
    require(viewer::parse_http_address(address.url().substr(7, address.url().size() - 8)).host ==
            address.host);
  });
  if (options.http_token.starts_with('@')) return;  // the name of a file
  is_allowed([&] {
    const std::string token = viewer::parse_http_token(options.http_token);
    require(viewer::carries_token("Bearer " + token, token));
  });
}

/// Checks that the configuration by the command line can be printed and read back. Configuration
/// files are tested by the target `config`.
template <class Description>
void check_settings(const Description& description, ProcessOptions options) {
  options.config_sources.files.clear();
  std::string printed;
  if (!is_allowed([&] { printed = description.config.dump(options); })) return;
  if (!options.print_config.empty())
    is_allowed([&] { description.config.value(options, options.print_config); });
  const std::span bytes{reinterpret_cast<const std::uint8_t*>(printed.data()), printed.size()};
  options.config_sources = {{memory_file(bytes)}, {}};
  options.seed.reset();
  require(description.config.dump(options) == printed);
}

template <class Description>
void check(Arguments& words, const Description& description, const OptionSet& option_set) {
  const ParsedOptions parsed =
      parse_options(words.count(), words.pointers(), description.traits, option_set);
  if (parsed.exit_code) return require(*parsed.exit_code == 0 || *parsed.exit_code == kExitUsage);
  check_numbers(parsed.options);
  is_allowed([&] { check_options(parsed.options, option_set); });
  is_allowed([&] { multicast_group_of(lcm_url_or_default(parsed.options.lcm_url)); });
  if (option_set.http) check_page(parsed.options);
  check_settings(description, parsed.options);
}

template <class NodeType>
void check_process(Arguments& words) {
  static const ProcessDescription description = describe_process<NodeType>();
  check(words, description, description.option_set);
}

void check_simulator(Arguments& words) {
  static const SimulatorDescription description = describe_simulator<SimNode>();
  check(words, description, kSimulatorOptions);
}

void check_command(Arguments& words) {
  const CommandLine line = parse_command_line(words.count(), words.pointers());
  if (line.exit_code) return require(*line.exit_code == 0 || *line.exit_code == kExitUsage);
  require(line.command.kind != 0);
  encode(channels::kSlamCommand, line.command);
}

}  // namespace
}  // namespace waymark::fuzz

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark;
  using namespace waymark::fuzz;
  std::cout.rdbuf(nullptr);  // silences --help and error messages
  std::cerr.rdbuf(nullptr);
  if (size == 0) return 0;
  Arguments words{{data + 1, size - 1}};
  switch (data[0] % 6) {
    case 0:
      check_simulator(words);
      break;
    case 1:
      check_process<DetectorNode>(words);
      break;
    case 2:
      check_process<SlamNode>(words);
      break;
    case 3:
      check_process<ViewerNode>(words);
      break;
    case 4:
      check_process<RecorderNode>(words);
      break;
    default:
      check_command(words);
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// main() of the simulator: it opens the ticks that the other processes acknowledge.
#pragma once

#include "common/node/node.hpp"
#include "common/robot/robot_config.hpp"
#include "common/runtime/options.hpp"
#include "common/runtime/run_process.hpp"

#include <functional>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

/// Source of the simulator's ticks: procs/sim has the real one, tests have small ones.
class TickSource {
 public:
  virtual ~TickSource() = default;

  /// Who must acknowledge each tick, in the order of the data flow.
  virtual std::vector<std::string> participants() const = 0;
  virtual int window_ticks() const = 0;
  /// Hash of everything that determines the run.
  virtual std::int64_t run_id() const = 0;
  /// The network has been joined and the run begins: only now may files be written.
  virtual void begin() = 0;
  /// The last tick has been made.
  virtual bool finished() const = 0;
  /// Simulates one tick. @return its messages, all stamped before `tick_end`, which is set here.
  virtual std::vector<Message> advance(Timestamp& tick_end) = 0;
  virtual double progress_fraction() const = 0;
  /// E.g. "x 12.3 m of 49.0 m".
  virtual std::string progress_text() const = 0;
  /// The run has ended, successfully or not.
  virtual void finish() = 0;
};

struct SimulatorDescription {
  ProcessTraits traits{};
  ConfigAccess config{};
  std::function<std::string(const ProcessOptions&)> dump_robot_config{};
  std::function<std::unique_ptr<TickSource>(const ProcessOptions&, Inbox&)> make_source{};
  std::vector<std::string_view> files{};  ///< names of the files that it writes into --out
};

/// The optional options of a simulator.
inline constexpr OptionSet kSimulatorOptions{
    .out_dir = true, .seed = true, .dump_robot_config = true};

int run_described_simulator(int argc, char** argv, const SimulatorDescription& description);

template <class Config>
ProcessConfig<Config> simulator_config_from(const ProcessOptions& options) {
  ProcessOptions with_seed = options;
  if (options.seed) {
    with_seed.config_sources.overrides.push_back("run.seed=" + std::to_string(*options.seed));
  }
  return process_config_from<Config>(with_seed);
}

template <class SourceType>
SimulatorDescription describe_simulator() {
  using Config = typename SourceType::Config;

  SimulatorDescription description;
  description.traits = SourceType::kTraits;
  description.files = {SourceType::kFiles.begin(), SourceType::kFiles.end()};
  description.config = config_access(simulator_config_from<Config>);
  description.dump_robot_config = [](const ProcessOptions& options) {
    return dump_robot_config(simulator_config_from<Config>(options).own.robot);
  };
  description.make_source = [](const ProcessOptions& options, Inbox& inbox) {
    return std::make_unique<SourceType>(simulator_config_from<Config>(options).own, inbox);
  };
  return description;
}

template <class SourceType>
int run_simulator(int argc, char** argv) {
  return run_described_simulator(argc, argv, describe_simulator<SourceType>());
}

}  // namespace waymark

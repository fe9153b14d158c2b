// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/options.hpp"

#include "common/command_line/command_line.hpp"
#include "common/errors/setup_error.hpp"
#include "common/files/writable_folder.hpp"
#include "common/log/log_file.hpp"

#include <fmt/format.h>

namespace waymark {

std::vector<std::filesystem::path> inputs_of(const ProcessOptions& options) {
  std::vector<std::filesystem::path> inputs = options.logs;
  const auto& files = options.config_sources.files;
  inputs.insert(inputs.end(), files.begin(), files.end());
  if (!options.load_map.empty()) inputs.push_back(options.load_map);
  return inputs;
}

ParsedOptions parse_options(int argc, char** argv, const ProcessTraits& traits,
                            const OptionSet& option_set) {
  ParsedOptions parsed;
  ProcessOptions& options = parsed.options;
  std::string mode;
  std::string start;
  const std::string name = "waymark-" + std::string{traits.name};
  Program app{std::string{traits.purpose}, name};
  app.add_option("--config", options.config_sources.files,
                 "TOML file; may be given several times, later files win");
  app.add_option("--set", options.config_sources.overrides,
                 "key.subkey=value; wins over the files; may be given several times");
  app.add_flag("--dump-config", options.dump_config,
               "print the effective configuration with every key explained, and exit");
  app.add_option("--print-config", options.print_config,
                 "print the effective value of this key alone, e.g. run.seed, and exit");
  app.add_flag("--check", options.check,
               fmt::format("check the configuration{}, and{} that the LCM network can be joined, "
                           "and exit",
                           option_set.maps ? ", the map to load" : "",
                           option_set.log ? " (without --log)" : ""));
  app.add_option("--lcm-url", options.lcm_url,
                 "LCM network (default: $LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0)");
  app.add_flag(
      "--real-time", options.real_time,
      "process what arrives when it arrives (a real robot) instead of in lockstep with the "
      "simulator");
  if (option_set.large_messages) {
    app.add_flag(
        "--large-messages", options.large_messages,
        "with --real-time: also take messages of several datagrams, such as large images of a "
        "camera driver; only in a network that you trust (see docs/reference.md, Limits)");
  }
  if (option_set.for_s) {
    app.add_option("--for-s", options.for_s,
                   "with --real-time: end after so many seconds, as by Ctrl-C")
        .check(positive_number());
  }
  if (option_set.log) {
    app.add_option(
        "--log", options.logs,
        "replay this LCM log instead of listening; may be given several times: a channel is "
        "taken from the last log that has it");
    app.add_flag("--print-channels", options.print_channels,
                 "with --log: print the names of the logs' channels, one in a line, and exit");
    app.add_option("--report", options.report,
                   "after a replay, write its timing, memory and counts there (JSON)");
    app.add_option("--skip-s", options.skip_s,
                   "with --log: leave out so many seconds of the log's beginning")
        .check(nonnegative_number());
    app.add_option("--until-s", options.until_s,
                   "with --log: read so many seconds from the log's beginning")
        .check(positive_number());
  }
  if (option_set.out_log) {
    app.add_option("--out-log", options.out_log, "write what is published to this LCM log");
  }
  if (option_set.out_dir) {
    app.add_option("--out", options.out_dir, "folder for the output files");
  }
  if (option_set.http) {
    app.add_option("--http", options.http,
                   "HOST:PORT: show the run as a live page there, e.g. 127.0.0.1:8080; with --log, "
                   "until Ctrl-C");
    app.add_option("--http-token", options.http_token,
                   "TOKEN or @FILE: whoever gives it on the live page may save the map, set the "
                   "pose and the mode, and reset (slam must have slam.commands = true)");
  }
  if (option_set.maps) {
    app.add_option("--load-map", options.load_map,
                   "map file of an earlier run; needs --mode localise or extend");
    app.add_option("--mode", mode,
                   "what the map to load is for: localise (it stays as it is) or extend (what is "
                   "new is added); short for --set slam.mode=NAME");
    app.add_option(
        "--start", start,
        "where in it the robot is: origin (default), pose (slam.start_pose), last (needs "
        "slam.state_folder) or anywhere; short for --set slam.start=NAME");
    app.add_option("--save-map", options.save_map, "write the map there at the end (NAME.map.lcm)");
  }
  if (option_set.seed) {
    app.add_option("--seed", options.seed, "seed of everything random (default: run.seed)");
  }
  if (option_set.dump_robot_config) {
    app.add_flag("--dump-robot-config", options.dump_robot_config,
                 "print what the other processes may know (section [robot]), and exit");
  }
  parsed.exit_code = app.parse(argc, argv);
  auto& overrides = options.config_sources.overrides;
  if (!mode.empty()) overrides.push_back("slam.mode=" + mode);
  if (!start.empty()) overrides.push_back("slam.start=" + start);
  return parsed;
}

void check_options(const ProcessOptions& options, const OptionSet& option_set) {
  const bool is_recorder = !option_set.log;
  const bool is_replay = !options.logs.empty();
  if (!is_replay && options.print_channels) throw SetupError{"--print-channels needs --log"};
  if (!is_replay && (options.skip_s > 0.0 || options.until_s))
    throw SetupError{"--skip-s and --until-s need --log"};
  if (!is_recorder && !is_replay && !options.out_log.empty()) {
    throw SetupError{"--out-log needs --log; live runs are recorded by waymark-recorder"};
  }
  if (is_replay && (options.real_time || !options.lcm_url.empty())) {
    throw SetupError{
        "--log reads a file and no network, as fast as it can: leave out --real-time and "
        "--lcm-url"};
  }
  if (options.large_messages && !options.real_time)
    throw SetupError{"--large-messages needs --real-time"};
  if (options.for_s && !options.real_time) throw SetupError{"--for-s needs --real-time"};
  if (!is_replay && !options.report.empty()) {
    throw SetupError{"--report needs --log: it is about a replay"};
  }
  if (!options.http_token.empty() && (is_replay || options.http.empty()))
    throw SetupError{"--http-token needs --http, and a run that is live: a log takes no commands"};
  if (!options.report.empty()) protect_inputs("--report", options.report, inputs_of(options));
  if (!options.out_log.empty()) protect_inputs("--out-log", options.out_log, inputs_of(options));
  if (options.save_map.empty()) return;
  std::vector<std::filesystem::path> inputs = inputs_of(options);
  std::erase(inputs, options.load_map);  // the map may be replaced by its extended version
  protect_inputs("--save-map", options.save_map, inputs);
  check_output_file("--save-map", options.save_map);
}

}  // namespace waymark

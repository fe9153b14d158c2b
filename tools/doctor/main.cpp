// SPDX-License-Identifier: BSD-3-Clause
#include "common/command_line/command_line.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/runtime/guard.hpp"
#include "common/runtime/progress.hpp"
#include "doctor/live_log.hpp"
#include "doctor/report.hpp"

#include <fmt/format.h>

#include <chrono>

namespace waymark {
namespace {

constexpr ProcessTraits kTraits{
    "doctor", "Says what is wrong with a robot's set-up, from a log or while it runs.", false};

constexpr double kQuiet_s = 2.0;  // shorter work needs no progress

struct Options {
  std::filesystem::path file{};
  std::vector<std::filesystem::path> robot{};
  std::filesystem::path write_robot{};
  bool as_json{false};
  int seconds{0};  ///< 0: a log
  std::string lcm_url{};
  InputChannels channels{};
};

auto show_in(Progress& progress) {
  return [&progress](double share) {
    if (progress.elapsed_s() > kQuiet_s) progress.show(share, "");
  };
}

DoctorInput listen(const Options& options) {
  Progress recording{"recording"};
  const LiveLog live{options.lcm_url, options.channels, std::chrono::seconds{options.seconds},
                     show_in(recording)};
  recording.done();
  log_counters(live.counters());
  return read_input(live.file(), options.robot, options.channels);
}

DoctorInput read(const Options& options) {
  Progress frames{"frames"};
  DoctorInput input = read_input(options.file, options.robot, options.channels, show_in(frames));
  frames.done();
  return input;
}

int run(const Options& options) {
  if (!options.write_robot.empty()) {
    if (std::filesystem::exists(options.write_robot)) {
      throw SetupError{options.write_robot.string() +
                       ": is there already; give --write-robot another name, or move it away"};
    }
    check_output_file("--write-robot", options.write_robot);
  }
  const DoctorInput input = options.seconds > 0 ? listen(options) : read(options);
  Progress scans{"scans"};
  const Diagnosis diagnosis = diagnose(input, show_in(scans));
  scans.done();
  fmt::print("{}", options.as_json ? to_json(diagnosis, input) : to_text(diagnosis.checks));
  if (!options.write_robot.empty()) {
    write_whole_file(options.write_robot,
                     to_robot_toml(diagnosis, options.seconds > 0 ? "a live run" : options.file));
  }
  return any_failed(diagnosis.checks) ? kExitFailed : kExitOk;
}

}  // namespace
}  // namespace waymark

int main(int argc, char** argv) {
  using namespace waymark;
  Options options;
  Program app{
      std::string{kTraits.purpose} + "\nExit code: 0 no FAIL, 1 a FAIL, 2 the log cannot be used.",
      "waymark-doctor"};
  CommandOption log =
      app.add_option("LOG", options.file, "LCM log, bag of ROS, or CARMEN log (text, gzip, bzip2)");
  CommandOption seconds =
      app.add_option(
             "--seconds", options.seconds,
             "instead of a log: listen to a running robot for so long; drive and turn meanwhile")
          .check({[](double s) { return s >= 1.0 && s <= 3600.0; }, "1 to 3600 seconds",
                  "INT in [1 - 3600]"})
          .excludes(log);
  app.add_option("--lcm-url", options.lcm_url,
                 "LCM network (default: $LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0)")
      .needs(seconds);
  app.add_option("--config", options.robot,
                 "robot.toml to hold it against; of several, later files win (default: the one "
                 "beside the log)");
  app.add_option("--write-robot", options.write_robot, "write a robot.toml with what was found");
  app.add_flag("--json", options.as_json, "one JSON object instead of text");
  app.add_option("--lidar-channel", options.channels.lidar,
                 "of an LCM log (default: the only one with scans)");
  app.add_option("--odometry-channel", options.channels.odometry,
                 "of an LCM log (default: ODOMETRY)");
  app.add_option("--encoder-channel", options.channels.encoders,
                 "of an LCM log without odometry (default: the only one with a MAEBot's ticks)");
  if (const auto exit_code = app.parse(argc, argv)) return *exit_code;
  if (!log.is_given() && !seconds.is_given()) return app.refuse_without("LOG or --seconds");
  return run_guarded(kTraits, [&] { return run(options); });
}

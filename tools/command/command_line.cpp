// SPDX-License-Identifier: BSD-3-Clause
#include "command/command_line.hpp"

#include "common/bus/ask_slam.hpp"
#include "common/command_line/command_line.hpp"

namespace waymark {

CommandLine parse_command_line(int argc, const char* const* argv) {
  CommandLine line;
  command_t& command = line.command;
  command.sigmas[0] = kPointedSigma_m;
  command.sigmas[1] = kPointedSigma_rad;
  std::string mode;

  Program program{
      "Asks a running slam to do something (it must have slam.commands = true).\n"
      "Exit code: 0 done; 1 refused, and why; 2 wrong usage; 4 no answer within 2 s.",
      "waymark-command"};
  program.add_option(
      "--lcm-url", line.lcm_url,
      "LCM network (default: $LCM_DEFAULT_URL, else udpm://239.255.76.67:7667?ttl=0)");
  program
      .add_option("--channels", line.channels_file,
                  "TOML file whose section [channels] says what SLAM_COMMAND and SLAM_REPLY are "
                  "called on the network")
      .existing_file();
  program.require_subcommand();
  program.allow_options_after_subcommand();
  Command save = program.add_subcommand("save", "save the map in slam's state folder");
  save.add_option("name", command.name, "NAME of NAME.map.lcm: letters, digits, _ and -")
      .required();
  save.when_given([&] { command.kind = command_t::KIND_SAVE_MAP; });
  program
      .add_subcommand("reset", "begin anew: a new map; with a loaded one, look for the robot in it")
      .when_given([&] { command.kind = command_t::KIND_RESET; });
  Command pose = program.add_subcommand("set-pose", "say where the robot is in the map");
  pose.add_option("x_m", command.pose[0], "base in the map").required();
  pose.add_option("y_m", command.pose[1], "base in the map").required();
  pose.add_option("yaw_rad", command.pose[2], "base in the map").required();
  pose.add_option("--sigma-m", command.sigmas[0], "how far x and y may be off (default 0.1)");
  pose.add_option("--sigma-rad", command.sigmas[1], "how far the heading may be off (default 0.1)");
  pose.when_given([&] { command.kind = command_t::KIND_SET_POSE; });
  Command set_mode = program.add_subcommand("set-mode", "go on in another mode");
  set_mode.add_option("mode", mode, "map, localise or extend")
      .required()
      .one_of({"map", "localise", "extend"});
  set_mode.when_given([&] {
    command.kind = command_t::KIND_SET_MODE;
    command.mode = command_modes().at(mode);
  });
  line.exit_code = program.parse(argc, argv);
  return line;
}

}  // namespace waymark

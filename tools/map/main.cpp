// SPDX-License-Identifier: BSD-3-Clause
// waymark-map: shows, checks, exports, transforms and merges map files.
#include "common/command_line/command_line.hpp"
#include "common/command_line/run_tool.hpp"
#include "common/logging/logging.hpp"
#include "map/map_commands.hpp"
#include "slam/map_file.hpp"

#include <fmt/format.h>

#include <cstdio>
#include <functional>

int main(int argc, char** argv) {
  using namespace waymark;
  std::filesystem::path file;
  std::filesystem::path other;
  std::filesystem::path out;
  std::string frame;
  bool as_json = false;
  bool is_forced = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  std::function<std::string()> command;

  Program program{
      "Shows, checks, exports, transforms and merges map files (NAME.map.lcm, written by "
      "waymark-slam --save-map).\n"
      "Exit code: 0 success; 1 not the whole map could be written; 2 wrong usage, no map file, or "
      "maps "
      "that do not fit.",
      "waymark-map"};
  program.require_subcommand();
  const auto add = [&](const char* name, const char* what) {
    Command added = program.add_subcommand(name, what);
    added.add_option("map", file, "map file").required();
    return added;
  };
  Command info = add("info", "print id, area, markers, pose graph and calibration of a map");
  info.add_flag("--json", as_json, "as one JSON object");
  info.when_given([&] {
    command = [&] {
      return map_info(file, as_json);
    };
  });
  Command check = add("check", "check that a map file is complete and undamaged");
  check.when_given([&] {
    command = [&] {
      read_map_file(file);
      return fmt::format("'{}' is whole\n", file.string());
    };
  });
  Command exported = add("export", "write map.pgm, map.yaml, map.png, markers.csv and graph.g2o");
  exported.add_option("--out", out, "folder without a map; created if missing").required();
  exported.when_given([&] {
    command = [&] {
      export_map(file, out);
      return fmt::format("map is in '{}'\n", out.string());
    };
  });
  Command transform = add("transform", "write the map in another frame");
  transform.add_option("--x-m", x_m, "x of the old origin in the new frame").check(finite_number());
  transform.add_option("--y-m", y_m, "y of the old origin in the new frame").check(finite_number());
  transform.add_option("--yaw-rad", yaw_rad, "direction of the old x axis in the new frame")
      .check(finite_number());
  transform.add_option("--frame", frame, "name of the new frame");
  transform.add_option("--out", out, "the new map file; must not exist yet").required();
  transform.when_given([&] {
    command = [&] {
      return transform_map(file, {x_m, y_m, yaw_rad}, frame, out) + "\n";
    };
  });
  Command merge =
      add("merge", "merge two maps, aligned by the markers in both, else by their walls");
  merge.add_option("other", other, "map file that is put into the frame of the first").required();
  merge.add_option("--out", out, "the new map file; must not exist yet").required();
  merge.add_flag("--force", is_forced,
                 "merge even if not more than half of the shared markers agree, or walls of one "
                 "map stand in the free space of the other");
  merge.when_given([&] {
    command = [&] {
      return merge_maps(file, other, out, is_forced ? MergeCheck::kForce : MergeCheck::kRefuse) +
             "\n";
    };
  });
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  logging::set_level(logging::Level::kWarn);
  return run_tool("waymark-map", [&] {
    fmt::print("{}", command());
    return kExitOk;
  });
}

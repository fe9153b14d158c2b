// SPDX-License-Identifier: BSD-3-Clause
// waymark-map: looks into map files, and makes new ones of them.
#include "common/runtime/number_checks.hpp"
#include "map/map_commands.hpp"
#include "slam/map_file.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cstdio>
#include <functional>

int main(int argc, char** argv) {
  using namespace waymark;
  std::filesystem::path file;
  std::filesystem::path other;
  std::filesystem::path out;
  std::string frame;
  bool as_json = false;
  double x_m = 0.0;
  double y_m = 0.0;
  double yaw_rad = 0.0;
  std::function<std::string()> command;

  CLI::App program{
      "Looks into map files (NAME.map.lcm, written by waymark-slam --save-map) and makes new "
      "ones.\n"
      "Exit code: 0 fine; 1 a file could not be written; 2 wrong usage, or no map."};
  program.set_version_flag("--version", "waymark-map " WAYMARK_VERSION);
  program.require_subcommand(1);
  const auto add = [&](const char* name, const char* what) -> CLI::App& {
    CLI::App& added = *program.add_subcommand(name, what);
    added.add_option("map", file, "map file")->required();
    return added;
  };
  CLI::App& info = add("info", "what a map is: id, area, markers, graph");
  info.add_flag("--json", as_json, "as one JSON object");
  info.callback([&] {
    command = [&] {
      return map_info(file, as_json);
    };
  });
  CLI::App& check = add("check", "whether a map file is whole");
  check.callback([&] {
    command = [&] {
      read_map_file(file);
      return fmt::format("'{}' is whole\n", file.string());
    };
  });
  CLI::App& exported = add("export", "map.pgm, map.yaml, map.png, markers.csv and graph.g2o");
  exported.add_option("--out", out, "folder; made if need be")->required();
  exported.callback([&] {
    command = [&] {
      export_map(file, out);
      return fmt::format("map is in '{}'\n", out.string());
    };
  });
  CLI::App& transform = add("transform", "the same map in another frame");
  transform.add_option("--x-m", x_m, "of the old origin in the new frame")->check(finite_number());
  transform.add_option("--y-m", y_m, "of the old origin in the new frame")->check(finite_number());
  transform.add_option("--yaw-rad", yaw_rad, "direction of the old x axis in the new frame")
      ->check(finite_number());
  transform.add_option("--frame", frame, "name of the new frame");
  transform.add_option("--out", out, "the new map file")->required();
  transform.callback([&] {
    command = [&] {
      return transform_map(file, {x_m, y_m, yaw_rad}, frame, out) + "\n";
    };
  });
  CLI::App& merge = add("merge", "two maps as one, by the markers in both, else by their walls");
  merge.add_option("other", other, "map file; comes out in the frame of the first")->required();
  merge.add_option("--out", out, "the new map file")->required();
  merge.callback([&] {
    command = [&] {
      return merge_maps(file, other, out) + "\n";
    };
  });
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  spdlog::set_level(spdlog::level::warn);
  try {
    fmt::print("{}", command());
    return 0;
  } catch (const SetupError& error) {
    fmt::print(stderr, "waymark-map: {}\n", error.what());
    return 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "waymark-map: {}\n", error.what());
    return 1;
  }
}

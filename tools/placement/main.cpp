// SPDX-License-Identifier: BSD-3-Clause
// waymark-placement, also run as `waymark-evaluate placement`: where additional markers would
// reduce the uncertainty of the position.
#include "common/command_line/command_line.hpp"
#include "common/command_line/run_tool.hpp"
#include "placement/placement_command.hpp"

#include <filesystem>
#include <string>

namespace {

using waymark::placement::PlacementOptions;

void add_options(waymark::Command& program, PlacementOptions& options) {
  program
      .add_option("RUN|MAP", options.source,
                  "folder of a run or of its row, or a map file (NAME.map.lcm)")
      .required();
  program
      .add_option("--target-sigma-m", options.target_m,
                  "standard deviation of the position, along the axis that the walls do not "
                  "observe, that is wanted everywhere on the path [m]")
      .check(waymark::positive_number())
      .show_default();
  program.add_option("--config", options.config,
                     "robot.toml or slam configuration; its keys win over the run's; needed for "
                     "a map file");
  program
      .add_option("--marker-height-m", options.marker_height_m,
                  "height of the markers' centres over the floor [m] (default: the median in the "
                  "run's log; without a log, the camera's height)")
      .check(waymark::positive_number());
  program.add_option("--json", options.json, "write the result to this JSON file");
  program.add_option("--csv", options.csv,
                     "write the new markers to this file, with the columns of markers.csv");
  program.add_option("--picture", options.picture,
                     "PNG file of the map with the places (default: placement.png in the row, "
                     "NAME.placement.png beside a map file)");
}

}  // namespace

int main(int argc, char** argv) {
  // waymark-evaluate calls it "waymark-evaluate placement".
  const std::string name = std::filesystem::path{argv[0]}.filename();
  PlacementOptions options;
  waymark::Program program{
      "Finds where the position is more uncertain than a target, and few new markers with which "
      "the target is met.\n"
      "Exit code: 0 the target is met, now or with the new markers; 1 no such markers were found; "
      "2 wrong usage or files.",
      name};
  add_options(program, options);
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  return waymark::run_tool(
      name, [&] { return waymark::placement::run_placement(options); }, waymark::kExitUsage);
}

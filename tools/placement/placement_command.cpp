// SPDX-License-Identifier: BSD-3-Clause
#include "placement/placement_command.hpp"

#include "common/files/whole_file.hpp"
#include "evaluate/commands.hpp"
#include "placement/placement_report.hpp"

#include <fmt/format.h>

namespace waymark::placement {
namespace {

namespace fs = std::filesystem;

fs::path picture_file(const PlacementOptions& options, const PlacementInput& input) {
  if (!options.picture.empty()) return options.picture;
  if (fs::is_directory(input.source)) return input.source / "placement.png";
  return input.source.parent_path() / (input.source.stem().stem().string() + ".placement.png");
}

}  // namespace

int run_placement(const PlacementOptions& options) {
  PlacementInput input = read_placement_input(options.source, options.config);
  if (options.marker_height_m > 0.0) input.marker_height_m = options.marker_height_m;
  if (!input.marker_height_m)
    input.notes.emplace_back(
        "no log says how high the markers hang: as high as the camera; --marker-height-m");
  const Placement placement = place_markers(
      input, options.target_m,
      [](const std::string& progress) { fmt::print(stderr, "placement: {}\n", progress); });
  fmt::print("{}", placement_text(input, placement));
  if (!options.json.empty()) write_whole_file(options.json, placement_json(input, placement));
  if (!options.csv.empty()) write_whole_file(options.csv, placement_csv(placement));
  const fs::path picture = picture_file(options, input);
  write_whole_file(picture, placement_picture(input, placement));
  fmt::print("picture: {}\n", picture.string());
  return placement.is_met() && !placement.is_model_refuted() ? kExitOk : kExitFailed;
}

}  // namespace waymark::placement

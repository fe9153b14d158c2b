// SPDX-License-Identifier: BSD-3-Clause
// waymark-marker-sheet: printable markers, one PNG each, at their true size.
#include "marker_sheet/marker_sheet.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

int main(int argc, char** argv) {
  using namespace waymark::marker_sheet;
  SheetOptions options;
  std::string ids = "0-23";
  std::filesystem::path folder;
  CLI::App program{
      "Writes one printable PNG per ArUco marker, at its true size when printed without scaling.\n"
      "Exit code: 0 fine; 2 wrong usage, or the folder cannot be written."};
  program.set_version_flag("--version", "waymark-marker-sheet " WAYMARK_VERSION);
  program.add_option("--dictionary", options.dictionary, "OpenCV's name")->capture_default_str();
  program.add_option("--ids", ids, "ids and ranges of ids, as in 0-5,9")->capture_default_str();
  program.add_option("--size-m", options.size_m, "side of the black square [m]")
      ->capture_default_str();
  program
      .add_option("--quiet-zone-modules", options.quiet_zone_modules,
                  "white border, in modules (the squares that a marker is made of)")
      ->capture_default_str();
  program.add_option("--dpi", options.dpi, "pixels per inch")->capture_default_str();
  program.add_option("--out", folder, "folder for the pictures; made if need be")->required();
  try {
    program.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  try {
    for (const int id : parse_ids(ids))
      fmt::print("{}\n", write_sheet(options, id, folder).string());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "waymark-marker-sheet: {}\n", error.what());
    return 2;
  }
}

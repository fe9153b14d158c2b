// SPDX-License-Identifier: BSD-3-Clause
// waymark-marker-sheet: markers and ChArUco boards to print at true size.
#include "common/command_line/command_line.hpp"
#include "common/command_line/run_tool.hpp"
#include "common/files/whole_file.hpp"
#include "marker_sheet/pdf_pages.hpp"

#include <fmt/format.h>

namespace waymark::marker_sheet {
namespace {

struct Options {
  SheetOptions sheet{};
  bool is_board{false};  ///< a ChArUco board instead of markers
  BoardOptions board{};
  PageOptions page{};
  std::string ids{"0-23"};
  std::filesystem::path pdf_file{};
  std::filesystem::path folder{};
};

std::vector<Pattern> marker_patterns(const Options& options) {
  std::vector<Pattern> patterns;
  for (const int id : parse_ids(options.ids))
    patterns.push_back(marker_pattern(options.sheet, id));
  return patterns;
}

void write_pdf(const Options& options, const std::vector<Pattern>& patterns) {
  const Pdf drawn = draw_pdf(patterns, options.page);
  write_whole_file(options.pdf_file, drawn.bytes);
  fmt::print("{}: {} pages\n", options.pdf_file.string(), drawn.num_pages);
}

void write_board(const Options& options) {
  const Pattern board = board_pattern(options.board);
  if (!options.pdf_file.empty()) return write_pdf(options, {board});
  const auto file = options.folder / fmt::format("charuco_{}_{}.png", options.board.dictionary,
                                                 options.board.squares);
  write_png(draw_picture(board, options.sheet.dpi), file);
  fmt::print("{}\n", file.string());
}

void write_markers(const Options& options) {
  if (!options.pdf_file.empty()) return write_pdf(options, marker_patterns(options));
  for (const auto& file : write_sheets(options.sheet, parse_ids(options.ids), options.folder))
    fmt::print("{}\n", file.string());
}

}  // namespace
}  // namespace waymark::marker_sheet

int main(int argc, char** argv) {
  using namespace waymark;
  using namespace waymark::marker_sheet;
  Options options;
  std::string dictionary;
  Program program{
      "Writes ArUco markers, or a ChArUco board for camera calibration, as PNGs or as one PDF. "
      "Printed without scaling they have their true size.\n"
      "Exit code: 0 success; 2 wrong usage, or the output cannot be written.",
      "waymark-marker-sheet"};
  program.add_option("--dictionary", dictionary,
                     fmt::format("OpenCV's name [{}; for a board {}]", options.sheet.dictionary,
                                 options.board.dictionary));
  CommandOption ids =
      program.add_option("--ids", options.ids, "ids and ranges of ids, as in 0-5,9").show_default();
  CommandOption size_m =
      program.add_option("--size-m", options.sheet.size_m, "side of the black square [m]")
          .show_default();
  CommandOption quiet_zone =
      program
          .add_option("--quiet-zone-modules", options.sheet.quiet_zone_modules,
                      "white border, in modules (the squares that a marker is made of)")
          .show_default();
  CommandOption charuco =
      program.add_flag("--charuco", options.is_board, "a ChArUco board instead of markers")
          .excludes(ids)
          .excludes(size_m)
          .excludes(quiet_zone);
  program.add_option("--squares", options.board.squares, "squares of the board: columns x rows")
      .show_default()
      .needs(charuco);
  program.add_option("--square-m", options.board.square_m, "side of the board's squares [m]")
      .show_default()
      .needs(charuco);
  program.add_option("--marker-m", options.board.marker_m, "side of the board's markers [m]")
      .show_default()
      .needs(charuco);
  CommandOption dpi =
      program.add_option("--dpi", options.sheet.dpi, "resolution of PNGs: pixels per inch")
          .show_default();
  CommandOption out =
      program.add_option("--out", options.folder, "folder for PNGs; created if missing");
  CommandOption to_pdf =
      program.add_option("--pdf", options.pdf_file, "instead of PNGs: one PDF with all pages");
  to_pdf.excludes(out).excludes(dpi);
  program.add_option("--page", options.page.page, "page size of the PDF: A4, A3 or Letter")
      .show_default()
      .needs(to_pdf);
  program
      .add_flag("--tile", options.page.tiles,
                "spread a marker or board that is too large over several pages with cut marks")
      .needs(to_pdf);
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  if (!out.is_given() && !to_pdf.is_given()) return program.refuse_without("--out or --pdf");
  if (!dictionary.empty()) options.sheet.dictionary = options.board.dictionary = dictionary;
  const auto write = [&] {
    options.is_board ? write_board(options) : write_markers(options);
    return kExitOk;
  };
  return run_tool("waymark-marker-sheet", write, kExitUsage);
}

// SPDX-License-Identifier: BSD-3-Clause
// waymark-marker-sheet: printable markers and ChArUco boards at their true size.
#include "common/files/whole_file.hpp"
#include "marker_sheet/pdf_pages.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

namespace waymark::marker_sheet {
namespace {

struct Options {
  SheetOptions sheet{};
  bool is_board{false};  ///< instead of markers
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
  for (const int id : parse_ids(options.ids))
    fmt::print("{}\n", write_sheet(options.sheet, id, options.folder).string());
}

}  // namespace
}  // namespace waymark::marker_sheet

int main(int argc, char** argv) {
  using namespace waymark::marker_sheet;
  Options options;
  std::string dictionary;
  CLI::App program{
      "Writes ArUco markers, or a ChArUco board to calibrate a camera with, at their true size "
      "when "
      "printed without scaling: PNGs, or the pages of a PDF.\n"
      "Exit code: 0 fine; 2 wrong usage, or nothing can be written there."};
  program.set_version_flag("--version", "waymark-marker-sheet " WAYMARK_VERSION);
  program.add_option("--dictionary", dictionary,
                     fmt::format("OpenCV's name [{}; of a board {}]", options.sheet.dictionary,
                                 options.board.dictionary));
  CLI::Option* ids = program.add_option("--ids", options.ids, "ids and ranges of ids, as in 0-5,9")
                         ->capture_default_str();
  CLI::Option* size_m =
      program.add_option("--size-m", options.sheet.size_m, "side of the black square [m]")
          ->capture_default_str();
  CLI::Option* quiet_zone =
      program
          .add_option("--quiet-zone-modules", options.sheet.quiet_zone_modules,
                      "white border, in modules (the squares that a marker is made of)")
          ->capture_default_str();
  CLI::Option* charuco =
      program.add_flag("--charuco", options.is_board, "a ChArUco board instead of markers")
          ->excludes(ids, size_m, quiet_zone);
  program.add_option("--squares", options.board.squares, "of the board: columns x rows")
      ->capture_default_str()
      ->needs(charuco);
  program.add_option("--square-m", options.board.square_m, "side of its squares [m]")
      ->capture_default_str()
      ->needs(charuco);
  program.add_option("--marker-m", options.board.marker_m, "side of its markers [m]")
      ->capture_default_str()
      ->needs(charuco);
  program.add_option("--dpi", options.sheet.dpi, "of PNGs: pixels per inch")->capture_default_str();
  CLI::Option* out =
      program.add_option("--out", options.folder, "folder for PNGs; made if need be");
  CLI::Option* to_pdf =
      program.add_option("--pdf", options.pdf_file, "instead: one PDF with all of them");
  to_pdf->excludes(out);
  program.add_option("--page", options.page.page, "of the PDF: A4, A3 or Letter")
      ->capture_default_str()
      ->needs(to_pdf);
  program
      .add_flag("--tile", options.page.tiles, "spread what does not fit over pages with cut marks")
      ->needs(to_pdf);
  try {
    program.parse(argc, argv);
    if (out->empty() && to_pdf->empty()) throw CLI::RequiredError{"--out or --pdf"};
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  if (!dictionary.empty()) options.sheet.dictionary = options.board.dictionary = dictionary;
  try {
    options.is_board ? write_board(options) : write_markers(options);
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "waymark-marker-sheet: {}\n", error.what());
    return 2;
  }
}

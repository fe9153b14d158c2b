// SPDX-License-Identifier: BSD-3-Clause
// waymark-marker-sheet: printable markers at their true size, one PNG each, or pages of a PDF.
#include "common/files/whole_file.hpp"
#include "marker_sheet/marker_sheet.hpp"
#include "marker_sheet/pdf_pages.hpp"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>

int main(int argc, char** argv) {
  using namespace waymark::marker_sheet;
  PdfOptions pdf;
  SheetOptions& options = pdf.sheet;
  std::filesystem::path pdf_file;
  std::string ids = "0-23";
  std::filesystem::path folder;
  CLI::App program{
      "Writes ArUco markers at their true size when printed without scaling: one PNG each, or the "
      "pages of a PDF.\nExit code: 0 fine; 2 wrong usage, or nothing can be written there."};
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
  CLI::Option* out = program.add_option("--out", folder, "folder for PNGs; made if need be");
  CLI::Option* to_pdf = program.add_option("--pdf", pdf_file, "instead: one PDF with all of them");
  to_pdf->excludes(out);
  program.add_option("--page", pdf.page, "of the PDF: A4, A3 or Letter")
      ->capture_default_str()
      ->needs(to_pdf);
  program.add_flag("--tile", pdf.tiles, "spread markers that do not fit over pages with cut marks")
      ->needs(to_pdf);
  try {
    program.parse(argc, argv);
    if (out->empty() && to_pdf->empty()) throw CLI::RequiredError{"--out or --pdf"};
  } catch (const CLI::ParseError& error) {
    return program.exit(error) == 0 ? 0 : 2;
  }
  try {
    if (!pdf_file.empty()) {
      const Pdf drawn = draw_pdf(pdf, parse_ids(ids));
      waymark::write_whole_file(pdf_file, drawn.bytes);
      fmt::print("{}: {} pages\n", pdf_file.string(), drawn.num_pages);
      return 0;
    }
    for (const int id : parse_ids(ids))
      fmt::print("{}\n", write_sheet(options, id, folder).string());
    return 0;
  } catch (const std::exception& error) {
    fmt::print(stderr, "waymark-marker-sheet: {}\n", error.what());
    return 2;
  }
}

// SPDX-License-Identifier: BSD-3-Clause
#include "marker_sheet/pattern.hpp"

#include <fmt/format.h>

namespace waymark::marker_sheet {
namespace {

/// Adds the black modules of a marker, row by row; adjacent ones become one rectangle.
void add_marker(Pattern& pattern, const cv::Mat& modules, double x_mm, double y_mm,
                double side_mm) {
  const double module_mm = side_mm / modules.cols;
  for (int row = 0; row < modules.rows; ++row) {
    for (int first = 0; first < modules.cols; ++first) {
      if (modules.at<unsigned char>(row, first) != 0) continue;
      int end = first;
      while (end < modules.cols && modules.at<unsigned char>(row, end) == 0)
        ++end;
      pattern.black.push_back(
          {x_mm + first * module_mm, y_mm + row * module_mm, (end - first) * module_mm, module_mm});
      first = end;
    }
  }
}

}  // namespace

Pattern marker_pattern(const SheetOptions& options, int id) {
  const cv::Mat modules = marker_modules(options, id);
  Pattern pattern;
  pattern.width_mm = pattern.height_mm = 1e3 * options.size_m;
  pattern.quiet_mm = options.quiet_zone_modules * pattern.width_mm / modules.cols;
  pattern.name = fmt::format("id {}", id);
  pattern.caption = fmt::format("{}  id {}  {:.4g} mm", options.dictionary, id, pattern.width_mm);
  add_marker(pattern, modules, 0.0, 0.0, pattern.width_mm);
  return pattern;
}

Pattern board_pattern(const BoardOptions& options) {
  const auto board = make_board(options);
  const cv::Size squares = board->getChessboardSize();
  const double square_mm = 1e3 * options.square_m;
  const double marker_mm = 1e3 * options.marker_m;
  Pattern pattern;
  pattern.width_mm = squares.width * square_mm;
  pattern.height_mm = squares.height * square_mm;
  pattern.quiet_mm = 0.5 * (square_mm - marker_mm);  // as around the board's markers
  pattern.name = "board " + options.squares;
  pattern.caption = fmt::format("ChArUco {}  {}  squares {:.4g} mm  markers {:.4g} mm",
                                options.squares, options.dictionary, square_mm, marker_mm);
  for (int row = 0; row < squares.height; ++row) {
    for (int column = row % 2; column < squares.width; column += 2)
      pattern.black.push_back({column * square_mm, row * square_mm, square_mm, square_mm});
  }
  SheetOptions sheet;
  sheet.dictionary = options.dictionary;
  for (std::size_t i = 0; i < board->ids.size(); ++i) {
    const cv::Point3f& top_left = board->objPoints[i][0];
    add_marker(pattern, marker_modules(sheet, board->ids[i]), 1e3 * top_left.x, 1e3 * top_left.y,
               marker_mm);
  }
  return pattern;
}

}  // namespace waymark::marker_sheet

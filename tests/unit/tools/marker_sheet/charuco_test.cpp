// SPDX-License-Identifier: BSD-3-Clause
// Printed boards are read back: every corner is where OpenCV's board has it.
#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "marker_sheet/pdf_pages.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <cstdlib>

namespace waymark::marker_sheet {
namespace {

using ::testing::HasSubstr;

constexpr double kPrecision_mm = 0.05;

/// Every inner corner of the board is seen, at its place relative to the first one.
void expect_board(const cv::Mat& picture, const BoardOptions& options, double px_per_mm) {
  const auto board = make_board(options);
  const BoardCorners found = find_corners(picture, board);
  EXPECT_EQ(found.marker_ids.size(), board->ids.size());
  ASSERT_EQ(found.ids.size(), board->chessboardCorners.size());
  const cv::Point3f first_m = board->chessboardCorners.front();
  for (std::size_t i = 0; i < found.ids.size(); ++i) {
    const cv::Point3f corner_m =
        board->chessboardCorners.at(static_cast<std::size_t>(found.ids[i]));
    const cv::Point2f way_px = found.corners_px[i] - found.corners_px[0];
    EXPECT_NEAR(way_px.x / px_per_mm, 1e3 * (corner_m.x - first_m.x), kPrecision_mm);
    EXPECT_NEAR(way_px.y / px_per_mm, 1e3 * (corner_m.y - first_m.y), kPrecision_mm);
  }
}

TEST(Charuco, PicturesReadBackAtTrueSize) {
  constexpr double kDpi = 200.0;
  for (const BoardOptions& options :
       {BoardOptions{}, BoardOptions{"6x4", 0.03, 0.02, "DICT_4X4_50"},
        BoardOptions{"5x8", 0.025, 0.02, "DICT_6X6_250"}}) {
    const Sheet sheet = draw_picture(board_pattern(options), kDpi);
    EXPECT_NEAR(sheet.pixels_per_m, kDpi / 0.0254, 1e-9);
    expect_board(sheet.picture, options, 1e-3 * sheet.pixels_per_m);
  }
}

TEST(Charuco, APdfReadsBackAtTrueSize) {
  if (std::system("command -v pdftoppm >/dev/null") != 0)
    GTEST_SKIP() << "no pdftoppm here; deploy/install-deps.sh --tests installs it";
  constexpr double kPxPerMm = 8.0;
  const BoardOptions options;
  const Pdf pdf = draw_pdf({board_pattern(options)}, {});
  EXPECT_EQ(pdf.num_pages, 1) << "the usual board fits A4";
  const evaluate::TemporaryFolder folder;
  write_whole_file(folder.path() / "board.pdf", pdf.bytes);
  const std::string command =
      fmt::format("pdftoppm -singlefile -r {} -gray {} {}", 25.4 * kPxPerMm,
                  (folder.path() / "board.pdf").string(), (folder.path() / "page").string());
  ASSERT_EQ(std::system(command.c_str()), 0) << command;
  expect_board(cv::imread((folder.path() / "page.pgm").string(), cv::IMREAD_GRAYSCALE), options,
               kPxPerMm);
}

std::string error_of(const BoardOptions& options) {
  try {
    board_pattern(options);
  } catch (const SetupError& error) {
    return error.what();
  }
  return "no error";
}

TEST(Charuco, InvalidBoardsAreRefused) {
  for (const char* squares : {"", "7", "7x", "x5", "7x5x3", "2x5", "7x-5", "7x61", "axb"})
    EXPECT_THAT(error_of({.squares = squares}), HasSubstr("--squares: got")) << squares;
  for (const double square_m : {0.0, -1.0, 1.1, std::nan("")})
    EXPECT_THAT(error_of({.square_m = square_m}), HasSubstr("--square-m")) << square_m;
  for (const double marker_m : {0.0, 0.03, 0.032, std::nan("")})
    EXPECT_THAT(error_of({.marker_m = marker_m}), HasSubstr("--marker-m")) << marker_m;
  EXPECT_THAT(error_of({.dictionary = "DICT_9X9"}), HasSubstr("expected one of DICT_4X4_50"));
  EXPECT_THAT(error_of({.squares = "11x10", .dictionary = "DICT_4X4_50"}),
              HasSubstr("11x10 need 55 markers, DICT_4X4_50 has 50"));
  EXPECT_EQ(error_of({}), "no error");
  EXPECT_THROW(draw_picture(board_pattern({}), 10.0), std::runtime_error);
}

}  // namespace
}  // namespace waymark::marker_sheet

// SPDX-License-Identifier: BSD-3-Clause
// Pages are drawn by poppler, as a printer would, and read by our detector.
#include "marker_sheet/pdf_pages.hpp"

#include "common/files/whole_file.hpp"
#include "detector/core/marker_detector.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <fmt/format.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <cstdlib>
#include <filesystem>

namespace waymark::marker_sheet {
namespace {

using ::testing::HasSubstr;

constexpr double kSame_mm = 0.2;

bool has_poppler() {
  return std::system("command -v pdftoppm >/dev/null") == 0;
}

struct PdfOptions {
  SheetOptions sheet{};
  PageOptions page{};
};

/// The markers with these ids.
Pdf draw_pdf(const PdfOptions& options, const std::vector<int>& ids) {
  std::vector<Pattern> patterns;
  for (const int id : ids)
    patterns.push_back(marker_pattern(options.sheet, id));
  return marker_sheet::draw_pdf(patterns, options.page);
}

PdfOptions options_of(const char* dictionary, double size_m, const char* page, bool tiles) {
  PdfOptions options;
  options.sheet.dictionary = dictionary;
  options.sheet.size_m = size_m;
  options.page = {page, tiles};
  return options;
}

/// One picture per page, in order.
std::vector<cv::Mat> rendered(const Pdf& pdf, double px_per_mm) {
  const evaluate::TemporaryFolder folder;
  write_whole_file(folder.path() / "sheet.pdf", pdf.bytes);
  const std::string command =
      fmt::format("pdftoppm -r {} -gray {} {}", 25.4 * px_per_mm,
                  (folder.path() / "sheet.pdf").string(), (folder.path() / "page").string());
  EXPECT_EQ(std::system(command.c_str()), 0) << command;
  std::vector<std::filesystem::path> files;
  for (const auto& entry : std::filesystem::directory_iterator{folder.path()}) {
    if (entry.path().extension() == ".pgm") files.push_back(entry.path());
  }
  std::ranges::sort(files);
  std::vector<cv::Mat> pages;
  for (const auto& file : files)
    pages.push_back(cv::imread(file.string(), cv::IMREAD_GRAYSCALE));
  return pages;
}

std::vector<MarkerDetection> markers_in(const cv::Mat& picture, const std::string& dictionary) {
  RobotConfig robot;
  robot.markers.dictionary = dictionary;
  robot.camera.width_px = picture.cols;
  robot.camera.height_px = picture.rows;
  robot.camera.cx_px = 0.5 * (picture.cols - 1);
  robot.camera.cy_px = 0.5 * (picture.rows - 1);
  robot.camera.fx_px = robot.camera.fy_px = picture.cols;
  return MarkerDetector{robot, {}}.detect(picture);
}

void expect_marker(const cv::Mat& picture, const std::string& dictionary, int id, double side_mm,
                   double px_per_mm) {
  const auto markers = markers_in(picture, dictionary);
  ASSERT_EQ(markers.size(), 1U) << dictionary << " " << id;
  EXPECT_EQ(markers[0].id, id);
  for (std::size_t k = 0; k < 4; ++k) {
    const auto& corners = markers[0].corners_px;
    const double length_mm = (corners[(k + 1) % 4] - corners[k]).norm() / px_per_mm;
    EXPECT_NEAR(length_mm, side_mm, kSame_mm) << dictionary << " " << id << ", side " << k;
  }
}

/// Length of the dark line in a row of pixels, with gaps of no more than a pixel.
int longest_line_px(const cv::Mat& picture, int row) {
  int longest = 0;
  int length = 0;
  for (int u = 0; u < picture.cols; ++u) {
    length = picture.at<unsigned char>(row, u) < 200 ? length + 1 : 0;
    longest = std::max(longest, length);
  }
  return longest;
}

TEST(PdfPages, EveryPageSizeReadsBackAtTrueSize) {
  if (!has_poppler())
    GTEST_SKIP() << "no pdftoppm here; deploy/install-deps.sh --tests installs it";
  constexpr double kPxPerMm = 10.0;

  struct Case {
    const char* page;
    const char* dictionary;
    double size_m;
    double width_mm;
    double height_mm;
  };

  for (const Case& c : {Case{"A4", "DICT_6X6_250", 0.12, 210.0, 297.0},
                        Case{"A3", "DICT_6X6_250", 0.18, 297.0, 420.0},
                        Case{"Letter", "DICT_4X4_50", 0.11, 215.9, 279.4}}) {
    const PdfOptions options = options_of(c.dictionary, c.size_m, c.page, false);
    const std::vector<int> ids{0, 7, 49};
    const Pdf pdf = draw_pdf(options, ids);
    EXPECT_EQ(pdf.num_pages, 3);
    const auto pages = rendered(pdf, kPxPerMm);
    ASSERT_EQ(pages.size(), ids.size());
    for (std::size_t i = 0; i < ids.size(); ++i) {
      EXPECT_NEAR(pages[i].cols, kPxPerMm * c.width_mm, 1.0);
      EXPECT_NEAR(pages[i].rows, kPxPerMm * c.height_mm, 1.0);
      expect_marker(pages[i], c.dictionary, ids[i], 1e3 * c.size_m, kPxPerMm);
    }
  }
}

TEST(PdfPages, TheRulerIs100MillimetresLong) {
  if (!has_poppler())
    GTEST_SKIP() << "no pdftoppm here; deploy/install-deps.sh --tests installs it";
  constexpr double kPxPerMm = 10.0;
  const PdfOptions options = options_of("DICT_6X6_250", 0.08, "A4", false);
  const SheetLayout sheet = layout_of(marker_pattern(options.sheet, 3));
  const Tiling tiling = tiling_of(sheet, "A4", false);
  const auto pages = rendered(draw_pdf(options, {3}), kPxPerMm);
  const double y_mm = kMargin_mm + tiling.offset_y_mm + sheet.ruler_y_mm;
  const int row = static_cast<int>(kPxPerMm * y_mm);
  const int length_px =
      std::max(longest_line_px(pages.at(0), row), longest_line_px(pages.at(0), row - 1));
  EXPECT_NEAR(length_px / kPxPerMm, kRuler_mm, kSame_mm);
}

TEST(PdfPages, TiledPagesReadBackWhenAssembled) {
  if (!has_poppler())
    GTEST_SKIP() << "no pdftoppm here; deploy/install-deps.sh --tests installs it";
  constexpr double kPxPerMm = 5.0;
  const PdfOptions options = options_of("DICT_6X6_250", 0.4, "A4", true);
  const Tiling tiling = tiling_of(layout_of(marker_pattern(options.sheet, 3)), "A4", true);
  const Pdf pdf = draw_pdf(options, {23});
  ASSERT_EQ(pdf.num_pages, tiling.columns * tiling.rows);
  ASSERT_GT(pdf.num_pages, 1);
  const auto pages = rendered(pdf, kPxPerMm);
  const cv::Rect inside{static_cast<int>(kPxPerMm * kMargin_mm),
                        static_cast<int>(kPxPerMm * kMargin_mm),
                        static_cast<int>(kPxPerMm * tiling.cell_width_mm),
                        static_cast<int>(kPxPerMm * tiling.cell_height_mm)};
  cv::Mat whole(tiling.rows * inside.height, tiling.columns * inside.width, CV_8UC1);
  for (int i = 0; i < pdf.num_pages; ++i) {
    const cv::Point corner{i % tiling.columns * inside.width, i / tiling.columns * inside.height};
    pages.at(static_cast<std::size_t>(i))(inside).copyTo(whole(cv::Rect{corner, inside.size()}));
  }
  expect_marker(whole, "DICT_6X6_250", 23, 400.0, kPxPerMm);
}

TEST(PdfPages, EveryTileHasARulerInItsMargin) {
  if (!has_poppler())
    GTEST_SKIP() << "no pdftoppm here; deploy/install-deps.sh --tests installs it";
  constexpr double kPxPerMm = 10.0;
  const Tiling tiling =
      tiling_of(layout_of(marker_pattern({"DICT_6X6_250", 0.4, 2, 300.0}, 3)), "A3", true);
  const auto pages = rendered(draw_pdf(options_of("DICT_6X6_250", 0.4, "A3", true), {3}), kPxPerMm);
  ASSERT_GT(pages.size(), 1U);
  for (const cv::Mat& page : pages) {
    const int row = static_cast<int>(kPxPerMm * (1.5 * kMargin_mm + tiling.cell_height_mm));
    const int length_px = std::max(longest_line_px(page, row), longest_line_px(page, row - 1));
    EXPECT_NEAR(length_px / kPxPerMm, kRuler_mm, kSame_mm);
  }
}

TEST(PdfPages, TheSameInputGivesTheSameBytes) {
  const PdfOptions options = options_of("DICT_6X6_250", 0.1, "A4", false);
  EXPECT_EQ(draw_pdf(options, {1, 2}).bytes, draw_pdf(options, {1, 2}).bytes);
}

std::string error_of(const PdfOptions& options, int id) {
  try {
    draw_pdf(options, {id});
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(PdfPages, MarkersThatDoNotFitOrAreInvalidAreRefused) {
  EXPECT_THAT(error_of(options_of("DICT_6X6_250", 0.4, "A4", false), 0),
              HasSubstr("A4 has 190 x 277 mm inside its margins: "
                        "give --tile (then it is 12 pages"));
  EXPECT_THAT(error_of(options_of("DICT_6X6_250", 0.4, "B5", true), 0),
              HasSubstr("--page: got 'B5', expected A4"));
  EXPECT_THAT(error_of(options_of("DICT_6X6_250", 0.4, "A4", true), 250),
              HasSubstr("ids 0 to 249, got 250"));
  EXPECT_THAT(error_of(options_of("DICT_6X6_250", 8.0, "A4", true), 0), HasSubstr("at most 100"));
  EXPECT_THAT(error_of(options_of("DICT_6X6_250", 0.0, "A4", true), 0), HasSubstr("--size-m"));
  EXPECT_EQ(error_of(options_of("DICT_6X6_250", 0.1, "A4", false), 0), "no error");
}

TEST(PdfPages, PagesAreRotatedIfThatNeedsFewer) {
  const SheetLayout wide{.width_mm = 250.0, .height_mm = 100.0};
  const Tiling tiling = tiling_of(wide, "A4", false);
  EXPECT_EQ(tiling.page.width_mm, 297.0);
  EXPECT_EQ(tiling.columns * tiling.rows, 1);
}

}  // namespace
}  // namespace waymark::marker_sheet

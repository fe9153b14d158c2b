// SPDX-License-Identifier: BSD-3-Clause
#include "marker_sheet/marker_sheet.hpp"

#include "common/markers/marker_dictionary.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/aruco.hpp>
#include <opencv2/imgcodecs.hpp>

namespace waymark::marker_sheet {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;

std::string error_of(const SheetOptions& options, int id) {
  try {
    draw_sheet(options, id);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "no error";
}

TEST(MarkerSheet, IdsAreParsedFromNumbersAndRanges) {
  EXPECT_THAT(parse_ids("0-3,7"), ElementsAre(0, 1, 2, 3, 7));
  for (const char* wrong : {"", "a", "3-1", "1-", "-1", "1,,2", "1-2-3", "0-999999999"})
    EXPECT_THROW(parse_ids(wrong), std::runtime_error) << wrong;
}

TEST(MarkerSheet, OpenCvReadsTheDrawnMarkerAtItsPlaceAndSize) {
  const SheetOptions options{"DICT_6X6_250", 0.1, 2, 100.0};
  const Sheet sheet = draw_sheet(options, 23);
  std::vector<int> ids;
  std::vector<std::vector<cv::Point2f>> corners;
  cv::aruco::detectMarkers(sheet.picture,
                           cv::makePtr<cv::aruco::Dictionary>(*find_dictionary("DICT_6X6_250")),
                           corners, ids);
  EXPECT_THAT(ids, ElementsAre(23));
  // 100 mm at 100 dpi are 393.7 pixels: 8 modules of 49, a quiet zone of 98.
  EXPECT_NEAR(sheet.pixels_per_m, 3920.0, 1e-9);
  EXPECT_NEAR(corners[0][0].x, 98, 1.0);
  EXPECT_NEAR(corners[0][0].y, 98, 1.0);
  EXPECT_NEAR(corners[0][2].x, 98 + 391, 1.0);
}

TEST(MarkerSheet, ThePictureFileHasItsPhysicalSize) {
  const evaluate::TemporaryFolder folder;
  const auto file =
      write_sheets({"DICT_4X4_50", 0.1, 1, 100.0}, {7}, folder.path() / "sheets").front();
  EXPECT_EQ(file.filename(), "marker_DICT_4X4_50_0007.png");
  EXPECT_FALSE(cv::imread(file.string(), cv::IMREAD_GRAYSCALE).empty());
  std::ifstream input{file, std::ios::binary};
  const std::string bytes{std::istreambuf_iterator<char>{input}, {}};
  // 6 modules of 66 pixels on 0.1 m: 3960 = 0x0f78 per metre.
  const std::string per_m{"\0\0\x0f\x78", 4};
  EXPECT_THAT(bytes, HasSubstr("pHYs" + per_m + per_m + '\1'));
}

TEST(MarkerSheet, NothingIsWrittenWhereOneIdIsRefused) {
  const evaluate::TemporaryFolder folder;
  EXPECT_THROW(write_sheets({"DICT_4X4_50", 0.1, 1, 100.0}, {7, 50}, folder.path() / "sheets"),
               std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "sheets"));
}

TEST(MarkerSheet, InvalidMarkersAreRefused) {
  EXPECT_THAT(error_of({"DICT_9X9", 0.4, 2, 300}, 0), HasSubstr("expected one of DICT_4X4_50"));
  EXPECT_THAT(error_of({"DICT_6X6_250", 0.4, 2, 300}, 250), HasSubstr("ids 0 to 249, got 250"));
  EXPECT_THAT(error_of({"DICT_6X6_250", 0.4, 0, 300}, 0), HasSubstr("--quiet-zone-modules"));
  for (const double size_m : {0.0, -1.0, 1e-6, 100.0, std::nan("")})
    EXPECT_THAT(error_of({"DICT_6X6_250", size_m, 2, 300}, 0), HasSubstr("--size-m")) << size_m;
  EXPECT_THAT(error_of({"DICT_6X6_250", 0.4, 2, -300}, 0), HasSubstr("--dpi"));
}

}  // namespace
}  // namespace waymark::marker_sheet

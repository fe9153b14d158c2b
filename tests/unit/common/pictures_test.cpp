// SPDX-License-Identifier: BSD-3-Clause
// JPEG and PNG against OpenCV's own codecs; headers of JPEGs written by hand.
#include "common/pictures/jpeg.hpp"
#include "common/pictures/jpeg_header.hpp"
#include "common/pictures/png.hpp"
#include "common/random/random.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <iterator>
#include <optional>
#include <vector>

namespace waymark {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr std::int64_t kMany = 1'000'000;

/// A smooth picture with noise, which JPEG changes.
cv::Mat picture(int type, cv::Size size = {61, 45}) {
  cv::Mat made{size, type};
  Random random{3, 1};
  for (int y = 0; y < made.rows; ++y)
    for (int x = 0; x < made.cols * made.channels(); ++x)
      made.ptr<std::uint8_t>(y)[x] =
          cv::saturate_cast<std::uint8_t>(2 * x + 3 * y + 40.0 * random.uniform());
  return made;
}

bool are_equal(const cv::Mat& a, const cv::Mat& b) {
  return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0.0;
}

std::span<const std::uint8_t> span_of(const std::string& bytes) {
  return {reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()};
}

/// A JPEG without its Huffman tables, as many cameras send it.
Bytes without_tables(const Bytes& jpeg) {
  Bytes out{jpeg.begin(), jpeg.begin() + 2};
  std::size_t at = 2;
  while (jpeg[at + 1] != 0xDA) {
    const std::size_t size = 2 + 256 * jpeg[at + 2] + jpeg[at + 3];
    if (jpeg[at + 1] != 0xC4) std::copy_n(jpeg.begin() + at, size, std::back_inserter(out));
    at += size;
  }
  out.insert(out.end(), jpeg.begin() + at, jpeg.end());
  return out;
}

TEST(Jpeg, IsEncodedAndDecodedAsByOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    for (const int quality : {25, 80, 95, 100}) {
      const cv::Mat image = picture(type);
      const Bytes ours = jpeg_bytes(image, quality);
      Bytes theirs;
      cv::imencode(".jpg", image, theirs, {cv::IMWRITE_JPEG_QUALITY, quality});
      EXPECT_EQ(ours, theirs) << type << " " << quality;
      EXPECT_TRUE(
          are_equal(grey_of_jpeg(ours, image.size()), cv::imdecode(ours, cv::IMREAD_GRAYSCALE)));
    }
  }
}

TEST(Jpeg, ASubmatrixIsEncodedAsItsCopy) {
  const cv::Mat whole = picture(CV_8UC3);
  const cv::Mat part = whole(cv::Rect{8, 4, 32, 24});
  EXPECT_EQ(jpeg_bytes(part, 90), jpeg_bytes(part.clone(), 90));
}

TEST(Jpeg, AnImageWithoutHuffmanTablesDecodesWithTheStandardOnes) {
  const cv::Mat image = picture(CV_8UC1);
  const Bytes jpeg = jpeg_bytes(image, 90);
  const Bytes bare = without_tables(jpeg);
  ASSERT_LT(bare.size(), jpeg.size());
  EXPECT_TRUE(are_equal(grey_of_jpeg(bare, image.size()), grey_of_jpeg(jpeg, image.size())));
}

TEST(Jpeg, DamagedBytesGiveAPictureOfTheRightSizeOrNone) {
  const cv::Mat image = picture(CV_8UC3);
  const Bytes good = jpeg_bytes(image, 90);
  Random random{5, 2};
  int decoded = 0;
  constexpr int kTrials = 300;
  for (int i = 0; i < kTrials; ++i) {
    Bytes bad = good;
    bad[static_cast<std::size_t>(random.uniform() * static_cast<double>(bad.size()))] ^= 0x55;
    if (i % 4 == 0) bad.resize(bad.size() / 2);
    const cv::Mat grey = grey_of_jpeg(bad, image.size());
    decoded += grey.empty() ? 0 : 1;
    EXPECT_TRUE(grey.empty() || grey.size() == image.size());
  }
  EXPECT_GT(decoded, kTrials / 4);
  EXPECT_LT(decoded, kTrials);
  EXPECT_TRUE(grey_of_jpeg({}, image.size()).empty());
  EXPECT_TRUE(grey_of_jpeg(good, {}).empty());
}

TEST(Png, EncodedPicturesDecodeToTheSamePixels) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    const cv::Mat image = picture(type);
    const std::string png = png_bytes(image);
    const Bytes bytes{png.begin(), png.end()};
    EXPECT_TRUE(are_equal(cv::imdecode(bytes, cv::IMREAD_UNCHANGED), image)) << type;
    const cv::Mat part = image(cv::Rect{8, 4, 32, 24});
    EXPECT_EQ(png_bytes(part), png_bytes(part.clone())) << type;
  }
}

TEST(Png, BecomesGreyAsByOpenCv) {
  for (const int type : {CV_8UC1, CV_8UC3}) {
    Bytes png;
    cv::imencode(".png", picture(type), png);
    cv::Mat grey = picture(type);
    if (type == CV_8UC3) cv::cvtColor(picture(type), grey, cv::COLOR_BGR2GRAY);
    EXPECT_TRUE(are_equal(grey_of_png(png, kMany), grey)) << type;
  }
}

TEST(Png, DamagedOrTooLargeImagesAreRefused) {
  const cv::Mat image = picture(CV_8UC3);
  const std::string png = png_bytes(image);
  EXPECT_TRUE(grey_of_png({}, kMany).empty());
  EXPECT_TRUE(grey_of_png(span_of("no PNG"), kMany).empty());
  EXPECT_TRUE(grey_of_png(span_of(png.substr(0, png.size() / 2)), kMany).empty());
  const std::int64_t pixels = std::int64_t{image.cols} * image.rows;
  EXPECT_TRUE(grey_of_png(span_of(png), pixels - 1).empty());
  EXPECT_FALSE(grey_of_png(span_of(png), pixels).empty());
}

/// A JPEG of one segment with this marker, 640 x 480 if it is a frame header.
std::optional<JpegHeader> header_of_segment(std::uint8_t marker) {
  const std::vector<std::uint8_t> bytes{0xFF, 0xD8, 0xFF, marker, 0,  11, 8,    1,   0xE0,
                                        2,    0x80, 1,    1,      17, 0,  0xFF, 0xD9};
  return read_jpeg_header(bytes);
}

TEST(JpegHeader, EveryKindOfFrameHeaderHasTheSizeOfTheImage) {
  for (const int marker : {0xC0, 0xC1, 0xC2, 0xC3, 0xC5, 0xC7, 0xC9, 0xCB, 0xCD, 0xCF}) {
    const auto header = header_of_segment(static_cast<std::uint8_t>(marker));
    ASSERT_TRUE(header) << marker;
    EXPECT_EQ(header->width_px, 640) << marker;
    EXPECT_EQ(header->height_px, 480) << marker;
    EXPECT_TRUE(header->complete) << marker;
  }
}

TEST(JpegHeader, OtherSegmentsAreNoFrameHeaders) {
  for (const int marker : {0xBF, 0xC4, 0xC8, 0xCC, 0xDB, 0xE0})
    EXPECT_FALSE(header_of_segment(static_cast<std::uint8_t>(marker))) << marker;
}

}  // namespace
}  // namespace waymark

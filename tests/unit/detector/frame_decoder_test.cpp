// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/frame_decoder.hpp"

#include "common/pictures/jpeg_header.hpp"
#include "common/random/random.hpp"

#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

#include <algorithm>
#include <vector>

namespace waymark {
namespace {

const cv::Size kSize{64, 48};

std::vector<std::uint8_t> jpeg_of(const cv::Mat& image) {
  std::vector<std::uint8_t> bytes;
  cv::imencode(".jpg", image, bytes);
  return bytes;
}

std::vector<std::uint8_t> gray_jpeg() {
  return jpeg_of(cv::Mat(kSize, CV_8UC1, cv::Scalar{77}));
}

FrameProblem problem_of(PixelFormat format, std::span<const std::uint8_t> bytes,
                        cv::Size said = kSize, int stride = 0) {
  const DecodedFrame frame = decode_frame({format, said.width, said.height, stride, bytes}, kSize);
  EXPECT_EQ(frame.gray.empty(), frame.problem != FrameProblem::kNone);
  return frame.problem;
}

/// Offset of the frame header's height field.
std::size_t height_at(const std::vector<std::uint8_t>& jpeg) {
  const std::vector<std::uint8_t> start_of_frame{0xFF, 0xC0};
  const auto found = std::ranges::search(jpeg, start_of_frame);
  return static_cast<std::size_t>(found.begin() - jpeg.begin()) + 5;
}

TEST(FrameDecoder, GrayAndColourJpegsBecomeGray) {
  const auto gray = decode_frame({PixelFormat::kMjpeg, 64, 48, 0, gray_jpeg()}, kSize).gray;
  ASSERT_EQ(gray.size(), kSize);
  EXPECT_NEAR(gray.at<std::uint8_t>(20, 20), 77, 1);

  const auto bytes = jpeg_of(cv::Mat(kSize, CV_8UC3, cv::Scalar{10, 200, 90}));
  const auto from_colour = decode_frame({PixelFormat::kMjpeg, 64, 48, 0, bytes}, kSize).gray;
  ASSERT_EQ(from_colour.type(), CV_8UC1);
  EXPECT_NEAR(from_colour.at<std::uint8_t>(20, 20), 0.114 * 10 + 0.587 * 200 + 0.299 * 90, 3);
}

TEST(FrameDecoder, RawFormatsHonourStrideAndChannelOrder) {
  constexpr int kStride = 3 * 64 + 5;
  std::vector<std::uint8_t> bytes(static_cast<std::size_t>(kStride) * 48, 0);
  bytes[2 * kStride + 3 * 7] = 255;  // row 2, column 7, first channel
  const auto rgb = decode_frame({PixelFormat::kRgb, 64, 48, kStride, bytes}, kSize).gray;
  const auto bgr = decode_frame({PixelFormat::kBgr, 64, 48, kStride, bytes}, kSize).gray;
  EXPECT_EQ(rgb.at<std::uint8_t>(2, 7), 76);
  EXPECT_EQ(bgr.at<std::uint8_t>(2, 7), 29);

  const std::vector<std::uint8_t> gray_bytes(64 * 48, 9);
  EXPECT_EQ(decode_frame({PixelFormat::kGray, 64, 48, 0, gray_bytes}, kSize)
                .gray.at<std::uint8_t>(47, 63),
            9);
}

TEST(FrameDecoder, BadFramesAreRefusedWithTheReason) {
  const std::vector<std::uint8_t> bytes(64 * 48, 1);
  EXPECT_EQ(problem_of(PixelFormat::kMjpeg, {}), FrameProblem::kEmpty);
  EXPECT_EQ(problem_of(PixelFormat::kOther, bytes), FrameProblem::kUnknownFormat);
  EXPECT_EQ(problem_of(PixelFormat::kMjpeg, bytes), FrameProblem::kNotAJpeg);
  EXPECT_EQ(problem_of(PixelFormat::kGray, bytes, {48, 64}), FrameProblem::kWrongSize);
  EXPECT_EQ(problem_of(PixelFormat::kGray, std::span{bytes}.first(64 * 48 - 1)),
            FrameProblem::kTooShort);
  EXPECT_EQ(problem_of(PixelFormat::kRgb, bytes), FrameProblem::kTooShort);
  EXPECT_EQ(problem_of(PixelFormat::kGray, bytes, kSize, 63), FrameProblem::kTooShort);
  EXPECT_EQ(problem_of(PixelFormat::kGray, bytes, kSize, -64), FrameProblem::kTooShort);
}

TEST(FrameDecoder, AJpegThatClaimsToBeHugeIsRefusedBeforeItIsDecoded) {
  auto bytes = gray_jpeg();
  const std::size_t at = height_at(bytes);
  bytes[at] = bytes[at + 2] = 0x4E;  // 20000 = 0x4E20
  bytes[at + 1] = bytes[at + 3] = 0x20;
  EXPECT_EQ(read_jpeg_header(bytes)->width_px, 20000);
  EXPECT_EQ(problem_of(PixelFormat::kMjpeg, bytes), FrameProblem::kWrongSize);
}

TEST(FrameDecoder, EveryTruncationIsRefused) {
  const auto bytes = gray_jpeg();
  for (std::size_t length = 1; length < bytes.size(); ++length) {
    EXPECT_NE(problem_of(PixelFormat::kMjpeg, std::span{bytes}.first(length)), FrameProblem::kNone)
        << length << " of " << bytes.size();
  }
}

TEST(FrameDecoder, RandomDamageIsHarmless) {
  const auto good = gray_jpeg();
  for (std::uint64_t seed = 0; seed < 300; ++seed) {
    Random random{seed};
    auto bytes = good;
    for (int i = 0; i < 5; ++i)
      bytes[random() % bytes.size()] = static_cast<std::uint8_t>(random());
    problem_of(PixelFormat::kMjpeg, bytes);  // any result is right, but it must return
  }
}

}  // namespace
}  // namespace waymark

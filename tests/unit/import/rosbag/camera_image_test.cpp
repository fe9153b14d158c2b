// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/camera_image.hpp"

#include "common/messages/message.hpp"
#include "common/pictures/jpeg.hpp"
#include "common/pictures/png.hpp"

#include <gtest/gtest.h>
#include <opencv2/core.hpp>

namespace waymark {
namespace {

using Bytes = std::vector<std::uint8_t>;

constexpr Timestamp kTime = timestamp_from_us(1'600'000'000'123'456);

RosImage of_pixels(const std::string& encoding, cv::Size size, int row_bytes, const Bytes& pixels) {
  return {.format = encoding,
          .width_px = size.width,
          .height_px = size.height,
          .row_bytes = row_bytes,
          .data = pixels};
}

RosImage compressed(const Bytes& bytes) {
  return {.format = "jpeg", .data = bytes};
}

cv::Mat grey_of(const image_t& message) {
  return grey_of_jpeg(message.data, {message.width, message.height});
}

/// Grey level of an image of one colour; negative if it cannot be read.
int grey_of_colour(const std::string& encoding, const Bytes& pixel) {
  constexpr int kSide_px = 16;
  Bytes pixels;
  for (int i = 0; i < kSide_px * kSide_px; ++i)
    pixels.insert(pixels.end(), pixel.begin(), pixel.end());
  const auto message = to_camera_message(
      of_pixels(encoding, {kSide_px, kSide_px}, kSide_px * static_cast<int>(pixel.size()), pixels),
      kTime);
  return message ? grey_of(*message).at<std::uint8_t>(8, 8) : -1;
}

cv::Mat noise(cv::Size size) {
  cv::Mat picture{size, CV_8UC1};
  cv::RNG{1}.fill(picture, cv::RNG::UNIFORM, 0, 256);
  return picture;
}

TEST(CameraImage, EachEncodingHasItsOrderOfColours) {
  // Share of red in the luma of Rec. ITU-R BT.601: 0.299; of blue: 0.114.
  constexpr int kOfRed = 76;
  constexpr int kOfBlue = 29;
  constexpr int kRounding = 2;
  for (const char* encoding : {"rgb8", "bgr8", "8UC3", "rgba8", "bgra8"}) {
    const bool is_red_first = std::string{encoding}.starts_with("rgb");
    Bytes pixel{255, 0, 0};
    if (std::string{encoding}.ends_with("a8")) pixel.push_back(255);
    EXPECT_NEAR(grey_of_colour(encoding, pixel), is_red_first ? kOfRed : kOfBlue, kRounding)
        << encoding;
  }
  for (const char* encoding : {"mono8", "8UC1"})
    EXPECT_NEAR(grey_of_colour(encoding, {100}), 100, kRounding) << encoding;
  for (const char* encoding : {"yuv422", "uyvy"})
    EXPECT_NEAR(grey_of_colour(encoding, {200, 100}), 100, kRounding) << encoding;
  for (const char* encoding : {"yuv422_yuy2", "yuyv"})
    EXPECT_NEAR(grey_of_colour(encoding, {100, 200}), 100, kRounding) << encoding;
}

TEST(CameraImage, BytesBehindTheRowsAreNoPixels) {
  constexpr int kWidth_px = 40;
  constexpr int kRow_bytes = 64;
  Bytes pixels;
  for (int i = 0; i < 30 * kRow_bytes; ++i)
    pixels.push_back(i % kRow_bytes < kWidth_px ? 100 : 0);
  const auto message =
      to_camera_message(of_pixels("mono8", {kWidth_px, 30}, kRow_bytes, pixels), kTime);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->utime, to_us(kTime));
  EXPECT_EQ(message->width, kWidth_px);
  EXPECT_EQ(message->height, 30);
  EXPECT_EQ(message->size, static_cast<int>(message->data.size()));
  EXPECT_NEAR(cv::mean(grey_of(*message))[0], 100.0, 1.0);
}

TEST(CameraImage, RowsShorterThanTheirPixelsAreDamage) {
  const Bytes pixels(std::size_t{40} * 30 * 3, 100);
  EXPECT_TRUE(to_camera_message(of_pixels("rgb8", {40, 30}, 120, pixels), kTime));
  EXPECT_FALSE(to_camera_message(of_pixels("rgb8", {40, 30}, 119, pixels), kTime));
}

TEST(CameraImage, AJpegIsKeptUnlessItIsTooLargeForAMessage) {
  const Bytes small = jpeg_bytes(noise({160, 120}), 90);
  const auto kept = to_camera_message(compressed(small), kTime);
  ASSERT_TRUE(kept);
  EXPECT_EQ(kept->data, small);
  EXPECT_EQ(kept->width, 160);
  EXPECT_EQ(kept->height, 120);

  const cv::Mat picture = noise({320, 240});
  const Bytes large = jpeg_bytes(picture, 100);
  ASSERT_GT(large.size(), kMaxPayloadBytes);
  const auto smaller = to_camera_message(compressed(large), kTime);
  ASSERT_TRUE(smaller);
  EXPECT_LT(smaller->data.size(), kMaxPayloadBytes);
  EXPECT_GT(smaller->data.size(), kMaxPayloadBytes / 2) << "no worse than necessary";
  EXPECT_LT(cv::norm(grey_of(*smaller), picture, cv::NORM_L1), 30.0 * 320 * 240);
}

TEST(CameraImage, APngIsRead) {
  const std::string png = png_bytes(cv::Mat{30, 40, CV_8UC1, cv::Scalar{100}});
  const Bytes bytes{png.begin(), png.end()};
  const auto message = to_camera_message(compressed(bytes), kTime);
  ASSERT_TRUE(message);
  EXPECT_EQ(message->width, 40);
  EXPECT_NEAR(cv::mean(grey_of(*message))[0], 100.0, 1.0);
}

TEST(CameraImage, AnImageThatFitsNoMessageIsNotConverted) {
  EXPECT_FALSE(to_camera_message(compressed(jpeg_bytes(noise({1600, 1200}), 90)), kTime));
  EXPECT_FALSE(to_camera_message(compressed({1, 2, 3}), kTime)) << "neither JPEG nor PNG";
}

}  // namespace
}  // namespace waymark

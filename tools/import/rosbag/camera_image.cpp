// SPDX-License-Identifier: BSD-3-Clause
#include "import/rosbag/camera_image.hpp"

#include "common/messages/message.hpp"
#include "common/pictures/jpeg.hpp"
#include "common/pictures/jpeg_header.hpp"
#include "common/pictures/png.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <vector>

namespace waymark {
namespace {

constexpr std::size_t kMaxImageBytes = kMaxPayloadBytes - 200;  // leaves room for the other fields
constexpr std::array kQualities{95, 90, 80, 70, 55, 40, 25};
constexpr std::int64_t kMaxPixels = 64'000'000;

struct PixelKind {
  std::string_view name;
  int type;
  int to_grey;  ///< code for cv::cvtColor; -1: the image is grey already
};

constexpr std::array kPixelKinds{
    PixelKind{"mono8", CV_8UC1, -1},
    PixelKind{"8UC1", CV_8UC1, -1},
    PixelKind{"bgr8", CV_8UC3, cv::COLOR_BGR2GRAY},
    PixelKind{"8UC3", CV_8UC3, cv::COLOR_BGR2GRAY},
    PixelKind{"rgb8", CV_8UC3, cv::COLOR_RGB2GRAY},
    PixelKind{"bgra8", CV_8UC4, cv::COLOR_BGRA2GRAY},
    PixelKind{"rgba8", CV_8UC4, cv::COLOR_RGBA2GRAY},
    PixelKind{"bayer_rggb8", CV_8UC1, cv::COLOR_BayerRGGB2GRAY},
    PixelKind{"bayer_bggr8", CV_8UC1, cv::COLOR_BayerBGGR2GRAY},
    PixelKind{"bayer_gbrg8", CV_8UC1, cv::COLOR_BayerGBRG2GRAY},
    PixelKind{"bayer_grbg8", CV_8UC1, cv::COLOR_BayerGRBG2GRAY},
    PixelKind{"yuv422", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
    PixelKind{"uyvy", CV_8UC2, cv::COLOR_YUV2GRAY_UYVY},
    PixelKind{"yuv422_yuy2", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
    PixelKind{"yuyv", CV_8UC2, cv::COLOR_YUV2GRAY_YUY2},
};

const PixelKind* kind_of(const RosImage& image) {
  const auto* const kind = std::ranges::find(kPixelKinds, image.format, &PixelKind::name);
  return kind == kPixelKinds.end() ? nullptr : kind;
}

std::optional<cv::Mat> grey_of_pixels(const RosImage& image) {
  const PixelKind* const kind = kind_of(image);
  if (kind == nullptr) return std::nullopt;
  const std::int64_t needed = std::int64_t{image.width_px} * CV_ELEM_SIZE(kind->type);
  if (needed > image.row_bytes) return std::nullopt;
  if (std::max(image.width_px, image.height_px) > kMaxJpegSide_px) return std::nullopt;
  const cv::Mat pixels{image.height_px, image.width_px, kind->type,
                       const_cast<std::uint8_t*>(image.data.data()),
                       static_cast<std::size_t>(image.row_bytes)};
  if (kind->to_grey < 0) return pixels;
  cv::Mat grey;
  cv::cvtColor(pixels, grey, kind->to_grey);
  return grey;
}

image_t message_of(Timestamp time, int width_px, int height_px, std::vector<std::uint8_t> jpeg) {
  image_t message{};
  message.utime = to_us(time);
  message.width = width_px;
  message.height = height_px;
  message.pixelformat = image_t::PIXEL_FORMAT_MJPEG;
  message.size = static_cast<std::int32_t>(jpeg.size());
  message.data = std::move(jpeg);
  return message;
}

std::optional<cv::Mat> decoded(const RosImage& image) {
  if (image.width_px > 0) return grey_of_pixels(image);
  cv::Mat grey;
  if (const auto header = read_jpeg_header(image.data); !header)
    grey = grey_of_png(image.data, kMaxPixels);
  else if (std::int64_t{header->width_px} * header->height_px <= kMaxPixels)
    grey = grey_of_jpeg(image.data, {header->width_px, header->height_px});
  return grey.empty() ? std::nullopt : std::optional{grey};
}

}  // namespace

bool has_known_encoding(const RosImage& image) {
  return image.width_px == 0 || kind_of(image) != nullptr;
}

std::optional<image_t> to_camera_message(const RosImage& image, Timestamp time) {
  const auto jpeg_sent = image.width_px == 0 ? read_jpeg_header(image.data) : std::nullopt;
  if (jpeg_sent && jpeg_sent->width_px > 0 && jpeg_sent->height_px > 0 &&
      image.data.size() <= kMaxImageBytes)
    return message_of(time, jpeg_sent->width_px, jpeg_sent->height_px,
                      {image.data.begin(), image.data.end()});
  const auto grey = decoded(image);
  if (!grey) return std::nullopt;
  for (const int quality : kQualities) {
    std::vector<std::uint8_t> jpeg = jpeg_bytes(*grey, quality);
    if (jpeg.size() <= kMaxImageBytes)
      return message_of(time, grey->cols, grey->rows, std::move(jpeg));
  }
  return std::nullopt;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/pictures/png.hpp"

#include <opencv2/imgproc.hpp>
#include <png.h>

#include <stdexcept>

namespace waymark {

std::string png_bytes(const cv::Mat& image) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  header.width = static_cast<png_uint_32>(image.cols);
  header.height = static_cast<png_uint_32>(image.rows);
  header.format = image.channels() == 1 ? PNG_FORMAT_GRAY : PNG_FORMAT_BGR;
  header.flags = PNG_IMAGE_FLAG_FAST;
  png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(header);
  std::string bytes(size, '\0');
  if (png_image_write_to_memory(&header, bytes.data(), &size, 0, image.data,
                                static_cast<png_int_32>(image.step), nullptr) == 0) {
    throw std::runtime_error{std::string{"a picture cannot be encoded as PNG: "} + header.message};
  }
  bytes.resize(size);
  return bytes;
}

cv::Mat grey_of_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels) {
  png_image header{};
  header.version = PNG_IMAGE_VERSION;
  if (png_image_begin_read_from_memory(&header, bytes.data(), bytes.size()) == 0) return {};
  if (std::int64_t{header.width} * header.height > max_pixels) {
    png_image_free(&header);
    return {};
  }
  header.format = PNG_FORMAT_BGR;
  header.flags |= PNG_IMAGE_FLAG_16BIT_sRGB;
  cv::Mat picture =
      cv::Mat::zeros(static_cast<int>(header.height), static_cast<int>(header.width), CV_8UC3);
  if (png_image_finish_read(&header, nullptr, picture.data, static_cast<png_int_32>(picture.step),
                            nullptr) == 0) {
    return {};
  }
  cv::Mat grey;
  cv::cvtColor(picture, grey, cv::COLOR_BGR2GRAY);
  return grey;
}

}  // namespace waymark

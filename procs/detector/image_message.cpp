// SPDX-License-Identifier: BSD-3-Clause
#include "detector/image_message.hpp"

namespace waymark {
namespace {

PixelFormat format_of(const image_t& image) {
  switch (image.pixelformat) {
    case image_t::PIXEL_FORMAT_GRAY:
      return PixelFormat::kGray;
    case image_t::PIXEL_FORMAT_RGB:
      return PixelFormat::kRgb;
    case image_t::PIXEL_FORMAT_BGR:
      return PixelFormat::kBgr;
    case image_t::PIXEL_FORMAT_MJPEG:
      return PixelFormat::kMjpeg;
    default:
      return PixelFormat::kOther;
  }
}

}  // namespace

DecodedFrame decode_image(const image_t& image, cv::Size expected_size) {
  return decode_frame({.format = format_of(image),
                       .width_px = image.width,
                       .height_px = image.height,
                       .row_stride_bytes = image.row_stride,
                       .bytes = image.data},
                      expected_size);
}

}  // namespace waymark

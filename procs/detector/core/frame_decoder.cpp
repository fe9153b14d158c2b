// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/frame_decoder.hpp"

#include "common/pictures/jpeg.hpp"
#include "common/pictures/jpeg_header.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>

namespace waymark {
namespace {

/// cv::Mat wants a mutable pointer; these views are only read.
cv::Mat view_of(std::span<const std::uint8_t> bytes, int rows, int columns, int type,
                std::size_t stride) {
  return {rows, columns, type, const_cast<std::uint8_t*>(bytes.data()), stride};
}

DecodedFrame decode_jpeg(std::span<const std::uint8_t> bytes, cv::Size expected_size) {
  const auto header = read_jpeg_header(bytes);
  if (!header) return {{}, FrameProblem::kNotAJpeg};
  const cv::Size size{header->width_px, header->height_px};
  if (size != expected_size) return {{}, FrameProblem::kWrongSize, size};
  if (!header->complete) return {{}, FrameProblem::kTruncatedJpeg};
  const cv::Mat gray = grey_of_jpeg(bytes, size);
  return {gray, gray.empty() ? FrameProblem::kBrokenJpeg : FrameProblem::kNone};
}

DecodedFrame decode_raw(const EncodedFrame& frame) {
  const bool is_gray = frame.format == PixelFormat::kGray;
  const std::size_t row_bytes = static_cast<std::size_t>(frame.width_px) * (is_gray ? 1 : 3);
  const std::size_t stride = frame.row_stride_bytes == 0
                                 ? row_bytes
                                 : static_cast<std::size_t>(std::max(0, frame.row_stride_bytes));
  const auto rows = static_cast<std::size_t>(frame.height_px);
  if (stride < row_bytes || frame.bytes.size() < stride * (rows - 1) + row_bytes) {
    return {{}, FrameProblem::kTooShort};
  }
  const cv::Mat pixels =
      view_of(frame.bytes, frame.height_px, frame.width_px, is_gray ? CV_8UC1 : CV_8UC3, stride);
  if (is_gray) return {pixels, FrameProblem::kNone};
  cv::Mat gray;
  cv::cvtColor(pixels, gray,
               frame.format == PixelFormat::kRgb ? cv::COLOR_RGB2GRAY : cv::COLOR_BGR2GRAY);
  return {gray, FrameProblem::kNone};
}

}  // namespace

std::string_view to_string(FrameProblem problem) {
  switch (problem) {
    case FrameProblem::kNone:
      return "none";
    case FrameProblem::kEmpty:
      return "empty image";
    case FrameProblem::kUnknownFormat:
      return "unknown pixel format";
    case FrameProblem::kWrongSize:
      return "image size is not the configured camera's";
    case FrameProblem::kTooShort:
      return "image shorter than its size says";
    case FrameProblem::kNotAJpeg:
      return "not a JPEG";
    case FrameProblem::kTruncatedJpeg:
      return "truncated JPEG";
    case FrameProblem::kBrokenJpeg:
      return "broken JPEG";
  }
  return "?";
}

DecodedFrame decode_frame(const EncodedFrame& frame, cv::Size expected_size) {
  if (frame.bytes.empty()) return {{}, FrameProblem::kEmpty};
  if (frame.format == PixelFormat::kOther) return {{}, FrameProblem::kUnknownFormat};
  const cv::Size size{frame.width_px, frame.height_px};
  if (size != expected_size) return {{}, FrameProblem::kWrongSize, size};
  if (frame.format == PixelFormat::kMjpeg) return decode_jpeg(frame.bytes, expected_size);
  return decode_raw(frame);
}

}  // namespace waymark

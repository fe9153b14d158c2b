// SPDX-License-Identifier: BSD-3-Clause
// Received image bytes -> grey image of the expected size, or the reason why not.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <span>
#include <string_view>

namespace waymark {

enum class PixelFormat { kGray, kRgb, kBgr, kMjpeg, kOther };

enum class FrameProblem {
  kNone,
  kEmpty,
  kUnknownFormat,
  kWrongSize,  ///< not the configured camera's width and height
  kTooShort,   ///< fewer bytes than height_px rows of row_stride_bytes need
  kNotAJpeg,
  kTruncatedJpeg,
  kBrokenJpeg,  ///< looks like a JPEG, but cannot be decoded
};

std::string_view to_string(FrameProblem problem);

/// An image as received.
struct EncodedFrame {
  PixelFormat format{PixelFormat::kOther};
  int width_px{0};
  int height_px{0};
  int row_stride_bytes{0};  ///< 0 = rows follow each other without gap
  std::span<const std::uint8_t> bytes{};
};

struct DecodedFrame {
  cv::Mat
      gray{};  ///< 8-bit, one channel; empty when there is a problem; may share the input's bytes
  FrameProblem problem{FrameProblem::kNone};
  cv::Size wrong_size{};  ///< size of the received image; set for kWrongSize only
};

/// The image size is checked before memory is allocated for it. Never throws for bad bytes.
DecodedFrame decode_frame(const EncodedFrame& frame, cv::Size expected_size);

}  // namespace waymark

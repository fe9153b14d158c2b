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
  kTooShort,   ///< fewer bytes than rows of that stride need
  kNotAJpeg,
  kTruncatedJpeg,
  kBrokenJpeg,  ///< looks like one, cannot be decoded
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
  cv::Size wrong_size{};  ///< of kWrongSize
};

/// Sizes are checked before anything is allocated for them. Never throws for bad bytes.
DecodedFrame decode_frame(const EncodedFrame& frame, cv::Size expected_size);

}  // namespace waymark

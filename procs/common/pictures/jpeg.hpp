// SPDX-License-Identifier: BSD-3-Clause
// Pictures <-> bytes of a JPEG.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <span>
#include <vector>

namespace waymark {

inline constexpr int kMaxJpegSide_px = 65500;

/// @param image    8 bit, grey or BGR, not empty, at most kMaxJpegSide_px wide and high.
/// @param quality  1 to 100.
std::vector<std::uint8_t> jpeg_bytes(const cv::Mat& image, int quality);

/// Bytes that are damaged behind the header may give a picture with wrong parts.
/// @param size  as read by read_jpeg_header().
/// @return 8 bit, grey; empty if it cannot be decoded.
cv::Mat grey_of_jpeg(std::span<const std::uint8_t> bytes, cv::Size size);

}  // namespace waymark

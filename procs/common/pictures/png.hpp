// SPDX-License-Identifier: BSD-3-Clause
// Pictures <-> bytes of a PNG file.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <span>
#include <string>

namespace waymark {

/// @param image  8 bit, grey or BGR, not empty.
/// @throws std::runtime_error if libpng cannot encode it.
std::string png_bytes(const cv::Mat& image);

/// @return 8 bit, grey; empty if the bytes cannot be decoded or are of more than `max_pixels`.
cv::Mat grey_of_png(std::span<const std::uint8_t> bytes, std::int64_t max_pixels);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Pictures -> bytes of a PNG file.
#pragma once

#include <opencv2/core.hpp>

#include <string>

namespace waymark::viewer {

/// @param image  8 bit, grey or BGR, not empty.
std::string png_bytes(const cv::Mat& image);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/png.hpp"

#include <opencv2/imgcodecs.hpp>

#include <stdexcept>
#include <vector>

namespace waymark::viewer {
std::string png_bytes(const cv::Mat& image) {
  std::vector<uchar> bytes;
  // OpenCV's default compression takes half of the time of any level that can be set, for files
  // that are a third larger.
  if (!cv::imencode(".png", image, bytes)) throw std::runtime_error{"OpenCV cannot encode PNG"};
  return {bytes.begin(), bytes.end()};
}

}  // namespace waymark::viewer

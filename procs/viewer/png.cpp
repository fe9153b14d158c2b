// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/png.hpp"

#include <opencv2/imgcodecs.hpp>

#include <stdexcept>
#include <vector>

namespace waymark::viewer {
namespace {

/// zlib level: pictures are written during the run, so speed counts more than the last percent.
constexpr int kCompression = 3;

}  // namespace

std::string png_bytes(const cv::Mat& image) {
  std::vector<uchar> bytes;
  if (!cv::imencode(".png", image, bytes, {cv::IMWRITE_PNG_COMPRESSION, kCompression}))
    throw std::runtime_error{"OpenCV cannot encode PNG"};
  return {bytes.begin(), bytes.end()};
}

}  // namespace waymark::viewer

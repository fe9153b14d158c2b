// SPDX-License-Identifier: BSD-3-Clause
#include "common/pictures/jpeg.hpp"

#include <turbojpeg.h>

#include <memory>
#include <stdexcept>

namespace waymark {
namespace {

struct Destroy {
  void operator()(void* handle) const { tjDestroy(handle); }
};

using Handle = std::unique_ptr<void, Destroy>;

struct Free {
  void operator()(unsigned char* bytes) const { tjFree(bytes); }
};

}  // namespace

std::vector<std::uint8_t> jpeg_bytes(const cv::Mat& image, int quality) {
  const bool is_grey = image.channels() == 1;
  const Handle compressor{tjInitCompress()};
  unsigned char* bytes = nullptr;
  unsigned long size = 0;
  const bool failed =
      compressor == nullptr ||
      tjCompress2(compressor.get(), image.data, image.cols, static_cast<int>(image.step),
                  image.rows, is_grey ? TJPF_GRAY : TJPF_BGR, &bytes, &size,
                  is_grey ? TJSAMP_GRAY : TJSAMP_420, quality, TJFLAG_ACCURATEDCT) != 0;
  const std::unique_ptr<unsigned char, Free> owned{bytes};
  if (failed) throw std::runtime_error{"a picture cannot be encoded as JPEG"};
  return {bytes, bytes + size};
}

cv::Mat grey_of_jpeg(std::span<const std::uint8_t> bytes, cv::Size size) {
  const Handle decompressor{tjInitDecompress()};
  cv::Mat grey = cv::Mat::zeros(size, CV_8UC1);
  if (decompressor == nullptr || grey.empty()) return {};
  const bool failed =
      tjDecompress2(decompressor.get(), bytes.data(), bytes.size(), grey.data, size.width,
                    static_cast<int>(grey.step), size.height, TJPF_GRAY, 0) != 0;
  // Warnings are accepted: some cameras add bytes between segments.
  if (failed && tjGetErrorCode(decompressor.get()) == TJERR_FATAL) return {};
  return grey;
}

}  // namespace waymark

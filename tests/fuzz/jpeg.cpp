// SPDX-License-Identifier: BSD-3-Clause
// Input: a JPEG. Its header is read, and its pixels are decoded.
#include "common/pictures/jpeg.hpp"

#include "common/pictures/jpeg_header.hpp"

#include <cstdint>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kMaxPixels = 1'000'000;
  const auto header = waymark::read_jpeg_header({data, size});
  if (!header) return 0;
  if (header->width_px < 0 || header->height_px < 0) std::abort();
  if (std::int64_t{header->width_px} * header->height_px > kMaxPixels) return 0;
  const cv::Size expected{header->width_px, header->height_px};
  const cv::Mat grey = waymark::grey_of_jpeg({data, size}, expected);
  if (!grey.empty() && grey.size() != expected) std::abort();
  return 0;
}

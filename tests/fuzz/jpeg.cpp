// SPDX-License-Identifier: BSD-3-Clause
// What a JPEG says about itself.
#include "common/jpeg/jpeg_header.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  const auto header = waymark::read_jpeg_header({data, size});
  if (header && (header->width_px < 0 || header->height_px < 0)) std::abort();
  return 0;
}

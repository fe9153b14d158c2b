// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "detector/core/frame_decoder.hpp"

#include <waymark/image_t.hpp>

namespace waymark {

/// decode_frame() of a message; the frame may share its bytes.
DecodedFrame decode_image(const image_t& image, cv::Size expected_size);

}  // namespace waymark

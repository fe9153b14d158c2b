// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "detector/core/frame_decoder.hpp"

#include <waymark/image_t.hpp>

namespace waymark {

/// Applies decode_frame() to an image message; the decoded frame may share the message's bytes.
DecodedFrame decode_image(const image_t& image, cv::Size expected_size);

}  // namespace waymark

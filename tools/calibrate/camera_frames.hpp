// SPDX-License-Identifier: BSD-3-Clause
// Camera frames from a folder of pictures or from a log.
#pragma once

#include <opencv2/core.hpp>

#include <cstdint>
#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace waymark::calibrate {

struct FrameCounts {
  std::int64_t num_frames{0};                                  ///< frames read or refused
  cv::Size size{};                                             ///< size of the first readable frame
  std::map<std::string, std::vector<std::string>> problems{};  ///< refused frames, by reason
};

using UseFrame = std::function<void(const std::string& name, const cv::Mat& gray)>;

/// Calls `use` for every frame that can be read and has the size of the first one: the pictures of
/// a folder by name, or up to 400 frames of CAMERA, evenly spread.
/// @throws SetupError when there are none.
FrameCounts read_frames(const std::filesystem::path& input, const UseFrame& use);

}  // namespace waymark::calibrate

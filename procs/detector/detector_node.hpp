// SPDX-License-Identifier: BSD-3-Clause
// The detector as a process: publishes one MARKERS message for each CAMERA frame that it handles.
#pragma once

#include "common/node/node.hpp"
#include "detector/core/frame_decoder.hpp"
#include "detector/debug_pictures.hpp"
#include "detector/detector_config.hpp"

#include <optional>

namespace waymark {

class DetectorNode final : public Node {
 public:
  using Config = DetectorConfig;
  static constexpr ProcessTraits kTraits{
      .name = "detector",
      .purpose = "Finds square markers in camera frames and measures their poses.",
      .joins_midway = true};

  /// @throws SetupError when the folder for debug pictures cannot be made.
  DetectorNode(const DetectorConfig& config, Inbox& inbox, Outbox& outbox);

  void finish() override {}

  std::vector<std::string_view> needed_channels() const override {
    return {channels::kCamera.name};
  }

 private:
  /// Publishes MARKERS for every frame; for an unreadable frame with an empty list, so that slam
  /// does not wait for its markers.
  void handle(const image_t& image);
  /// Keeps at most as many markers as a message can hold: the widest in the image, which are
  /// measured most accurately.
  void keep_largest(std::vector<MarkerDetection>& markers);
  void count(const MarkerDetections& detections);
  /// Counts the problem of a frame; logs the size of the first frame of a wrong size.
  void reject(const DecodedFrame& frame);

  cv::Size image_size_;
  MarkerDetector detector_;
  std::optional<DebugPictures> debug_pictures_;
  Inbox& inbox_;
  Outbox& outbox_;
};

}  // namespace waymark

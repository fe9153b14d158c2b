// SPDX-License-Identifier: BSD-3-Clause
// The detector as a process: CAMERA in, MARKERS out, one for one.
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

 private:
  /// Answers every frame, an unreadable one with an empty list, so that slam does not wait for it.
  void handle(const image_t& image);
  void leave_out_what_does_not_fit(std::vector<MarkerDetection>& markers);
  void count(const MarkerDetections& detections);
  /// Counts; says of the first image of another size which one it has.
  void reject(const DecodedFrame& frame);

  cv::Size image_size_;
  MarkerDetector detector_;
  std::optional<DebugPictures> debug_pictures_;
  Inbox& inbox_;
  Outbox& outbox_;
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "detector/detector_node.hpp"

#include "common/logging/logging.hpp"
#include "common/messages/convert.hpp"
#include "detector/image_message.hpp"

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <functional>
#include <iterator>
#include <string>
#include <utility>

namespace waymark {
namespace {

constexpr std::size_t kMarkersPerMessage = 130;  // each takes 492 bytes

}  // namespace

DetectorNode::DetectorNode(const DetectorConfig& config, Inbox& inbox, Outbox& outbox)
    : image_size_{config.robot.camera.width_px, config.robot.camera.height_px},
      detector_{config.robot, config.detector},
      inbox_{inbox},
      outbox_{outbox} {
  if (!config.detector.debug_dir.empty()) {
    debug_pictures_.emplace(config.detector.debug_dir, config.detector.debug_every);
  }
  // One thread: OpenCV's own threads gain nothing on images this small.
  cv::setNumThreads(1);
  inbox.on<image_t>(
      channels::kCamera, [this](const image_t& image) { handle(image); }, Backlog::kNewestOnly);
}

void DetectorNode::handle(const image_t& image) {
  MarkerDetections detections{.time = timestamp_from_us(image.utime),
                              .image_width_px = image_size_.width,
                              .image_height_px = image_size_.height};
  const DecodedFrame frame = decode_image(image, image_size_);
  if (frame.problem == FrameProblem::kNone) {
    ImageMarkers found = detector_.examine(frame.gray);
    detections.detections = std::move(found.markers);
    if (found.beyond_lens > 0) {
      inbox_.counters().add("markers dropped: robot.camera.distortion cannot be inverted there",
                            CountKind::kLoss, found.beyond_lens);
    }
    keep_largest(detections.detections);
    if (debug_pictures_ && !debug_pictures_->offer(frame.gray, detections)) {
      inbox_.counters().add("debug pictures not written", CountKind::kLoss);
    }
    count(detections);
  } else {
    reject(frame);
  }
  outbox_.publish(channels::kMarkers, to_detections_message(detections));
}

void DetectorNode::keep_largest(std::vector<MarkerDetection>& markers) {
  if (markers.size() <= kMarkersPerMessage) return;
  inbox_.counters().add("markers dropped: more than a message holds", CountKind::kLoss,
                        std::ssize(markers) - std::int64_t{kMarkersPerMessage});
  std::ranges::stable_sort(markers, std::greater{}, &MarkerDetection::width_px);
  markers.resize(kMarkersPerMessage);
}

void DetectorNode::count(const MarkerDetections& detections) {
  const bool any = !detections.detections.empty();
  inbox_.counters().add(any ? "frames with markers" : "frames without markers");
  inbox_.counters().add("markers detected", CountKind::kEvent, std::ssize(detections.detections));
}

void DetectorNode::reject(const DecodedFrame& frame) {
  const std::string name = "CAMERA rejected: " + std::string{to_string(frame.problem)};
  if (frame.problem == FrameProblem::kWrongSize && inbox_.counters().get(name) == 0) {
    logging::error(
        "an image of {} x {} px is refused: robot.camera.width_px and height_px say {} x {}",
        frame.wrong_size.width, frame.wrong_size.height, image_size_.width, image_size_.height);
  }
  inbox_.counters().add(name, CountKind::kRejection);
}

}  // namespace waymark

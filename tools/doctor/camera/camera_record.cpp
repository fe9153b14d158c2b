// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/camera/camera_record.hpp"

#include "common/log/log_file.hpp"
#include "common/markers/marker_dictionary.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "detector/core/corner_refinement.hpp"
#include "detector/core/marker_detector.hpp"
#include "detector/image_message.hpp"
#include "slam/core/scan/marker_sighting.hpp"

#include <opencv2/core/utility.hpp>

#include <algorithm>
#include <array>

namespace waymark {
namespace {

constexpr std::int64_t kMaxFrames = 400;
constexpr std::size_t kMaxMessages = 1200;
constexpr std::int64_t kDictionaryFrames = 30;

/// The largest dictionary of every family: the smaller ones are its first ids.
constexpr std::array<std::string_view, 9> kFamilies{
    "DICT_4X4_1000",      "DICT_5X5_1000",       "DICT_6X6_1000",
    "DICT_7X7_1000",      "DICT_ARUCO_ORIGINAL", "DICT_APRILTAG_16h5",
    "DICT_APRILTAG_25h9", "DICT_APRILTAG_36h10", "DICT_APRILTAG_36h11"};

std::optional<CameraSighting> sighting_of(const RobotConfig& robot, Timestamp time,
                                          const MarkerDetection& marker) {
  const auto sighting = sight_marker(marker, time, {}, robot.markers.size_m);
  if (!sighting) return std::nullopt;
  const Eigen::Isometry3d base_from_camera = robot.camera.base_from_camera();
  const Eigen::Matrix3d turn = base_from_camera.linear();
  CameraSighting in_camera{.id = marker.id, .time = time};
  in_camera.place_in_camera =
      base_from_camera.inverse() * Eigen::Vector3d{marker.base_from_marker.translation()};
  in_camera.covariance_in_camera =
      turn.transpose() * marker.covariance_in_base.topLeftCorner<3, 3>() * turn;
  in_camera.facing_rad = sighting->base_from_marker.theta();
  return in_camera;
}

class CameraReader {
 public:
  explicit CameraReader(const RobotConfig& robot)
      : robot_{robot},
        detector_{robot, {}},
        described_{*find_dictionary(robot.markers.dictionary), {}},
        patterns_{marker_patterns(*find_dictionary(robot.markers.dictionary))} {
    for (const std::string_view family : kFamilies)
      finders_.emplace_back(family, CandidateFinder{*find_dictionary(family), {}});
  }

  void add(const image_t& image, bool try_dictionaries) {
    ++record_.num_examined;
    const DecodedFrame frame =
        decode_image(image, {robot_.camera.width_px, robot_.camera.height_px});
    if (frame.problem != FrameProblem::kNone) {
      ++record_.problems[std::string{to_string(frame.problem)}];
      return;
    }
    for (const MarkerDetection& marker : detector_.detect(frame.gray))
      add(frame.gray, timestamp_from_us(image.utime), marker);
    if (!try_dictionaries) return;
    record_.markers_of_described += std::ssize(described_.find(frame.gray));
    for (const auto& [name, finder] : finders_) {
      for (const MarkerCandidate& marker : finder.find(frame.gray)) {
        ++record_.markers_by_dictionary[name];
        int& largest = record_.largest_id[name];
        largest = std::max(largest, marker.id);
      }
    }
  }

  CameraRecord& record() { return record_; }

 private:
  void add(const cv::Mat& gray, Timestamp time, const MarkerDetection& marker) {
    const auto sighting = sighting_of(robot_, time, marker);
    if (!sighting) return;
    record_.sightings.push_back(*sighting);
    const MarkerPattern& pattern = patterns_[static_cast<std::size_t>(marker.id)];
    const MeasuredCorners corners =
        refine_corners(gray, CameraModel{robot_.camera}, marker.corners_px, pattern, {});
    if (!corners.refined) return;
    record_.blurs_px.push_back(corners.blur_px);
    record_.modules_px.push_back(marker.width_px / pattern.modules());
  }

  RobotConfig robot_;
  MarkerDetector detector_;
  CandidateFinder described_;
  std::vector<MarkerPattern> patterns_;                             ///< by id
  std::vector<std::pair<std::string, CandidateFinder>> finders_{};  ///< by family
  CameraRecord record_{};
};

}  // namespace

CameraRecord read_markers(const std::filesystem::path& lcm_log, const RobotConfig& robot) {
  const auto is_markers = [](std::string_view channel) {
    return channel == channels::kMarkers.name;
  };
  CameraRecord record;
  record.has_images = false;
  LogReader reader{lcm_log};
  std::vector<MarkerDetections> frames;
  while (const auto event = reader.next(is_markers)) {
    const auto message = decode<marker_detections_t>(event->payload);
    if (!message.message) {
      ++record.problems["damaged message"];
      continue;
    }
    frames.push_back(to_detections(*message.message));
    record.times.push_back(frames.back().time);
  }
  record.num_examined = std::ssize(frames);
  const std::size_t every = 1 + frames.size() / kMaxMessages;
  for (std::size_t i = 0; i < frames.size(); i += every) {
    for (const MarkerDetection& marker : frames[i].detections) {
      if (const auto sighting = sighting_of(robot, frames[i].time, marker))
        record.sightings.push_back(*sighting);
    }
  }
  return record;
}

CameraRecord read_camera(const std::filesystem::path& lcm_log, const RobotConfig& robot,
                         const ShowProgress& progress) {
  cv::setNumThreads(1);
  const auto is_camera = [](std::string_view channel) {
    return channel == channels::kCamera.name;
  };
  std::int64_t num_frames = 0;
  for (LogReader reader{lcm_log}; reader.next(is_camera);)
    ++num_frames;
  CameraReader camera{robot};
  const std::int64_t every = 1 + num_frames / kMaxFrames;
  const std::int64_t every_for_dictionaries = every * (1 + num_frames / every / kDictionaryFrames);
  LogReader reader{lcm_log};
  std::int64_t number = 0;
  while (const auto event = reader.next(is_camera)) {
    const std::int64_t current = number++;
    const auto time = time_of(event->payload);
    if (time) camera.record().times.push_back(*time);
    if (current % every != 0) continue;
    if (progress) progress(static_cast<double>(current) / static_cast<double>(num_frames));
    const auto image = decode<image_t>(event->payload);
    if (image.message) {
      camera.add(*image.message, current % every_for_dictionaries == 0);
    } else {
      ++camera.record().num_examined;
      ++camera.record().problems["damaged message"];
    }
  }
  return std::move(camera.record());
}

}  // namespace waymark

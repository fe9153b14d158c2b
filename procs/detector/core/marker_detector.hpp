// SPDX-License-Identifier: BSD-3-Clause
// The three stages of detection: one grey image in, markers with poses and covariances out.
#pragma once

#include "common/robot/camera_model.hpp"
#include "common/robot/robot_config.hpp"
#include "common/sensors/sensors.hpp"
#include "detector/core/corner_refinement.hpp"
#include "detector/core/marker_candidates.hpp"
#include "detector/core/square_pose.hpp"

#include <opencv2/core.hpp>

#include <optional>
#include <set>
#include <vector>

namespace waymark {

/// Standard deviations of the errors of the camera's calibration; their squares are added to the
/// covariance of every pose. Zero: intrinsics and mounting are exact, as in simulation. A carefully
/// calibrated real camera: range_rate 0.005, bearing_rad 0.005 (0.3 degrees), orientation_rad 0.017
/// (1 degree).
struct CalibrationErrorConfig {
  double range_rate{0.0};
  double bearing_rad{0.0};
  double orientation_rad{0.0};

  void describe(Fields& fields);
};

/// Parameters of all stages.
struct MarkerDetectorConfig {
  CandidateConfig candidates{};
  RefinementConfig refinement{};
  CalibrationErrorConfig calibration_error{};
  double max_reprojection_px{3.0};

  void describe(Fields& fields);
};

/// What examine() finds in an image.
struct ImageMarkers {
  std::vector<MarkerDetection> markers{};
  int beyond_lens{0};  ///< markers dropped: robot.camera.distortion has no inverse at a corner
};

class MarkerDetector {
 public:
  /// @throws std::invalid_argument when robot.markers.dictionary is no dictionary.
  MarkerDetector(const RobotConfig& robot, const MarkerDetectorConfig& config);

  /// Markers of the configured ids, ordered by id, then from left to right. One id may occur more
  /// than once: an id is a class of markers, not a key.
  /// @param gray 8-bit, one channel, of the configured camera's size.
  std::vector<MarkerDetection> detect(const cv::Mat& gray) const { return examine(gray).markers; }

  /// detect(), with the count of the markers that it dropped.
  ImageMarkers examine(const cv::Mat& gray) const;

 private:
  bool is_within_lens(const MarkerCandidate& candidate) const;
  std::optional<MarkerDetection> measure(const cv::Mat& gray,
                                         const MarkerCandidate& candidate) const;
  Eigen::Matrix<double, 6, 6> covariance_in_base(const SquarePoses& poses) const;

  MarkerConfig markers_;
  std::set<int> known_ids_;
  MarkerDetectorConfig config_;
  CameraModel camera_;
  Eigen::Isometry3d base_from_camera_;
  std::vector<MarkerPattern> patterns_;  ///< by id
  CandidateFinder finder_;
};

}  // namespace waymark

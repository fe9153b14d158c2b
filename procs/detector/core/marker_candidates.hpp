// SPDX-License-Identifier: BSD-3-Clause
// First stage: ids and approximate corners of the markers in an image.
#pragma once

#include "common/config/fields.hpp"

#include <Eigen/Core>
#include <opencv2/aruco.hpp>
#include <opencv2/core.hpp>

#include <array>
#include <vector>

namespace waymark {

using Corners = std::array<Eigen::Vector2d, 4>;  ///< [px] clockwise from the marker's top left

/// Those parameters of cv::aruco that differ from OpenCV's defaults or that users may need to
/// change.
struct CandidateConfig {
  int threshold_window_min_px{3};
  int threshold_window_max_px{23};
  int threshold_window_step_px{10};
  /// At OpenCV's default of 7, noise gives false edges; from 10 on, pale markers in photographs are
  /// missed.
  double threshold_constant{8.0};
  double error_correction_rate{0.6};
  double min_perimeter_rate{0.03};
  /// At OpenCV's default of 0.05, the outer edge of a white quiet zone before a dark wall replaces
  /// the marker's own edge, and the marker is missed.
  double min_marker_distance_rate{0.02};
  double polygon_accuracy_rate{0.03};
  int border_distance_px{3};

  void describe(Fields& fields);
};

struct MarkerCandidate {
  int id{0};
  Corners corners_px{};  ///< raw image, to about half a pixel, biased inwards
};

/// Finds and reads markers with cv::aruco, without its corner refinement.
class CandidateFinder {
 public:
  CandidateFinder(const cv::aruco::Dictionary& dictionary, const CandidateConfig& config);

  /// @param gray 8-bit, one channel. @return ordered by id, then from left to right.
  std::vector<MarkerCandidate> find(const cv::Mat& gray) const;

 private:
  cv::Ptr<cv::aruco::Dictionary> dictionary_;
  cv::Ptr<cv::aruco::DetectorParameters> parameters_;
};

}  // namespace waymark

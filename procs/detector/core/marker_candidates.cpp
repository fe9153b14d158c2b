// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/marker_candidates.hpp"

#include <algorithm>
#include <tuple>

namespace waymark {

void CandidateConfig::describe(Fields& fields) {
  fields.field("threshold_window_min_px", threshold_window_min_px, {3, 999},
               "smallest window of the adaptive threshold");
  fields.field("threshold_window_max_px", threshold_window_max_px, {3, 999}, "largest window");
  fields.field("threshold_window_step_px", threshold_window_step_px, {1, 999},
               "step from window to window");
  fields.field("threshold_constant", threshold_constant, kNotNegative,
               "grey levels below the window's mean that count as black; larger is faster in noisy "
               "images and loses far markers");
  fields.field("error_correction_rate", error_correction_rate, kFraction,
               "share of the dictionary's correctable bits that is corrected");
  fields.field("min_perimeter_rate", min_perimeter_rate, {0.001, 4.0},
               "smallest marker perimeter as a share of the larger image side");
  fields.field("min_marker_distance_rate", min_marker_distance_rate, {0.001, 1.0},
               "quads with corners nearer than this share of their perimeter are one");
  fields.field("polygon_accuracy_rate", polygon_accuracy_rate, {0.001, 0.3},
               "tolerance of the search for quads, share of the perimeter");
  fields.field("border_distance_px", border_distance_px, {0, 100},
               "nearest distance of a corner to the image border");
}

CandidateFinder::CandidateFinder(const cv::aruco::Dictionary& dictionary,
                                 const CandidateConfig& config)
    : dictionary_{cv::makePtr<cv::aruco::Dictionary>(dictionary)},
      parameters_{cv::aruco::DetectorParameters::create()} {
  parameters_->adaptiveThreshWinSizeMin = config.threshold_window_min_px;
  parameters_->adaptiveThreshWinSizeMax =
      std::max(config.threshold_window_min_px, config.threshold_window_max_px);
  parameters_->adaptiveThreshWinSizeStep = config.threshold_window_step_px;
  parameters_->adaptiveThreshConstant = config.threshold_constant;
  parameters_->errorCorrectionRate = config.error_correction_rate;
  parameters_->minMarkerPerimeterRate = config.min_perimeter_rate;
  parameters_->minMarkerDistanceRate = config.min_marker_distance_rate;
  parameters_->polygonalApproxAccuracyRate = config.polygon_accuracy_rate;
  parameters_->minDistanceToBorder = config.border_distance_px;
  parameters_->cornerRefinementMethod = cv::aruco::CORNER_REFINE_NONE;
}

std::vector<MarkerCandidate> CandidateFinder::find(const cv::Mat& gray) const {
  std::vector<std::vector<cv::Point2f>> all_corners;
  std::vector<int> ids;
  cv::aruco::detectMarkers(gray, dictionary_, all_corners, ids, parameters_);

  std::vector<MarkerCandidate> candidates;
  for (std::size_t i = 0; i < ids.size(); ++i) {
    MarkerCandidate candidate{.id = ids[i]};
    for (std::size_t k = 0; k < 4; ++k) {
      candidate.corners_px[k] = {all_corners[i][k].x, all_corners[i][k].y};
    }
    candidates.push_back(candidate);
  }
  std::ranges::sort(candidates, {}, [](const MarkerCandidate& candidate) {
    return std::tuple{candidate.id, candidate.corners_px[0].x(), candidate.corners_px[0].y()};
  });
  return candidates;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Least-squares fit of a lens to views of a board.
#pragma once

#include "calibrate/board_view.hpp"

#include <array>

namespace waymark::calibrate {

struct LensFit {
  /// fx fy cx cy [px], k1 k2 p1 p2 k3, and their standard deviations.
  std::array<double, 9> values{};
  std::array<double, 9> sigmas{};
  double rms_px{};                                       ///< reprojection error
  std::vector<BoardView> views{};                        ///< the views used
  std::vector<std::vector<cv::Point2f>> residuals_px{};  ///< observed minus predicted, by view
  std::vector<std::string> dropped{};                    ///< names of outlier views
  std::size_t num_dropped_corners{0};                    ///< outliers in the views used
  double bearing_sigma_rad{};                            ///< remaining error of the lens model
  double focal_sigma{};                                  ///< relative; the larger of fx and fy
};

/// Drops views with more than three times the median error (moved or bent board), then corners with
/// more than five times the median residual (false detections).
/// @throws std::runtime_error when the views do not determine a lens.
LensFit fit_lens(const std::vector<BoardView>& views, cv::Size image);

}  // namespace waymark::calibrate

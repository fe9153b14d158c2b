// SPDX-License-Identifier: BSD-3-Clause
// Least squares of a lens over views of a board.
#pragma once

#include "calibrate/board_view.hpp"

#include <array>

namespace waymark::calibrate {

struct LensFit {
  /// fx fy cx cy [px], k1 k2 p1 p2 k3, and their standard deviations.
  std::array<double, 9> values{};
  std::array<double, 9> sigmas{};
  double rms_px{};                                       ///< of the distances of corners
  std::vector<BoardView> views{};                        ///< that were used
  std::vector<std::vector<cv::Point2f>> residuals_px{};  ///< seen less predicted, by view
  std::vector<std::string> dropped{};                    ///< views that do not fit the others
  std::size_t num_dropped_corners{0};                    ///< of the views that were used
  double bearing_sigma_rad{};                            ///< what is left of the lens
  double focal_sigma{};                                  ///< relative, the larger of both
};

/// Views with more than three times the median error (moved, or bent) are dropped,
/// then corners with more than five times the median residual (found at the wrong place).
/// @throws std::runtime_error where the views determine no lens.
LensFit fit_lens(const std::vector<BoardView>& views, cv::Size image);

}  // namespace waymark::calibrate

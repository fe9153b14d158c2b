// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/camera_calibration.hpp"

#include <fmt/format.h>

#include <stdexcept>

namespace waymark::calibrate {
namespace {

constexpr double kFocalSigma = 0.005;   // relative; waymark-doctor warns of errors from 1 % on
constexpr double kLargestRms_px = 2.0;  // above it, the board is bent, or not as described

void add_missing(const LensFit& fit, std::vector<std::string>& missing) {
  if (!(fit.rms_px <= kLargestRms_px))
    missing.push_back(
        fmt::format("a board that is flat, still, and as --squares and --marker-m say "
                    "(the reprojection error is {:.2f} px, at most {} px are good)",
                    fit.rms_px, kLargestRms_px));
  if (!(fit.focal_sigma > 0.0 && fit.focal_sigma <= kFocalSigma))
    missing.push_back(
        fmt::format("views nearer, and turned further: the focal length is only known to {:.2f} %, "
                    "{} % are good",
                    100.0 * fit.focal_sigma, 100.0 * kFocalSigma));
}

}  // namespace

void fit_views(CameraCalibration& calibration, const std::vector<BoardView>& found) {
  const cv::Size image = calibration.frames.size;
  calibration.num_with_board = found.size();
  calibration.views = different_views(found);
  calibration.missing = missing_in(calibration.views, image);
  if (!calibration.missing.empty()) return;
  try {
    calibration.fit = fit_lens(calibration.views, image);
  } catch (const std::runtime_error& error) {
    calibration.missing.emplace_back(error.what());
    return;
  }
  // Without the outliers, the views still have to be sufficient.
  calibration.missing = missing_in(calibration.fit->views, image);
  add_missing(*calibration.fit, calibration.missing);
}

CameraCalibration calibrate_camera(const std::filesystem::path& input,
                                   const cv::Ptr<cv::aruco::CharucoBoard>& board) {
  CameraCalibration calibration;
  std::vector<BoardView> found;
  calibration.frames = read_frames(input, [&](const std::string& name, const cv::Mat& gray) {
    if (auto view = find_board(name, gray, board)) {
      found.push_back(std::move(*view));
    } else {
      calibration.without_board.push_back(name);
    }
  });
  fit_views(calibration, found);
  return calibration;
}

}  // namespace waymark::calibrate

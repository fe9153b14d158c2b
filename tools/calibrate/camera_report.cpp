// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/camera_report.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <array>
#include <span>

namespace waymark::calibrate {
namespace {

constexpr std::size_t kMaxNames = 10;
constexpr float kMagnified = 100.0F;

std::string names(const std::vector<std::string>& all) {
  const std::span shown{all.data(), std::min(all.size(), kMaxNames)};
  return fmt::format(
      "{}{}", fmt::join(shown, ", "),
      all.size() > kMaxNames ? fmt::format(" and {} more", all.size() - kMaxNames) : "");
}

std::size_t num_corners(const LensFit& fit) {
  std::size_t sum = 0;
  for (const BoardView& view : fit.views)
    sum += view.corners_px.size();
  return sum;
}

std::string values_with_sigmas(const LensFit& fit) {
  constexpr std::array<const char*, 9> kNames{"fx", "fy", "cx", "cy", "k1", "k2", "p1", "p2", "k3"};
  std::vector<std::string> parts;
  for (std::size_t i = 0; i < kNames.size(); ++i)
    parts.push_back(fmt::format("{} {:.{}f} ± {:.{}f}", kNames[i], fit.values[i], i < 4 ? 3 : 5,
                                fit.sigmas[i], i < 4 ? 3 : 5));
  return fmt::format("{}", fmt::join(parts, ", "));
}

}  // namespace

std::string to_text(const CameraCalibration& calibration) {
  std::string text = fmt::format("{} frames, {} with the board, {} different views\n",
                                 calibration.frames.num_frames, calibration.num_with_board,
                                 calibration.views.size());
  for (const auto& [reason, frames] : calibration.frames.problems)
    text += fmt::format("{} frames not used, {}: {}\n", frames.size(), reason, names(frames));
  if (!calibration.without_board.empty())
    text += fmt::format("{} frames without the board: {}\n", calibration.without_board.size(),
                        names(calibration.without_board));
  if (!calibration.fit) return text;
  const LensFit& fit = *calibration.fit;
  if (!fit.dropped.empty())
    text += fmt::format("{} views do not fit the others and are left out: {}\n", fit.dropped.size(),
                        names(fit.dropped));
  if (fit.num_dropped_corners > 0)
    text += fmt::format("{} corners do not fit and are left out\n", fit.num_dropped_corners);
  return text + fmt::format(
                    "reprojection error {:.3f} px over {} corners of {} views\n{}\n"
                    "focal length known to {:.3f} %, bearings to {:.6f} rad\n",
                    fit.rms_px, num_corners(fit), fit.views.size(), values_with_sigmas(fit),
                    100.0 * fit.focal_sigma, fit.bearing_sigma_rad);
}

std::string refusal(const CameraCalibration& calibration, const std::string& input) {
  return fmt::format("{}: not enough to calibrate from, missing: {}", input,
                     fmt::join(calibration.missing, "; "));
}

std::string to_camera_toml(const CameraCalibration& calibration, const std::string& input) {
  const LensFit& fit = calibration.fit.value();
  const auto& lens = fit.values;
  return fmt::format(
      "# By waymark-calibrate camera, from {}:\n"
      "# reprojection error {:.3f} px over {} corners of {} views;\n"
      "# {}\n"
      "[robot.camera]\n"
      "width_px = {}\n"
      "height_px = {}\n"
      "fx_px = {:.4f}\n"
      "fy_px = {:.4f}\n"
      "cx_px = {:.4f}\n"
      "cy_px = {:.4f}\n"
      "distortion = [{:.8f}, {:.8f}, {:.8f}, {:.8f}, {:.8f}]\n"
      "focal_sigma = {:.8f}\n"
      "bearing_sigma_rad = {:.8f}\n",
      input, fit.rms_px, num_corners(fit), fit.views.size(), values_with_sigmas(fit),
      calibration.frames.size.width, calibration.frames.size.height, lens[0], lens[1], lens[2],
      lens[3], lens[4], lens[5], lens[6], lens[7], lens[8], fit.focal_sigma, fit.bearing_sigma_rad);
}

cv::Mat coverage_picture(const CameraCalibration& calibration) {
  const cv::Scalar paper{255, 255, 255};
  const cv::Scalar grid{200, 200, 200};
  const cv::Scalar corner{180, 90, 0};
  const cv::Scalar residual{0, 0, 200};
  const cv::Size size = calibration.frames.size;
  cv::Mat picture{size, CV_8UC3, paper};
  for (int part = 1; part < 3; ++part) {
    cv::line(picture, {part * size.width / 3, 0}, {part * size.width / 3, size.height}, grid);
    cv::line(picture, {0, part * size.height / 3}, {size.width, part * size.height / 3}, grid);
  }
  const auto& views = calibration.fit ? calibration.fit->views : calibration.views;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t i = 0; i < views[v].corners_px.size(); ++i) {
      const cv::Point2f seen_px = views[v].corners_px[i];
      if (calibration.fit)
        cv::line(picture, seen_px, seen_px + kMagnified * calibration.fit->residuals_px[v][i],
                 residual, 1, cv::LINE_AA);
      cv::circle(picture, seen_px, 2, corner, cv::FILLED, cv::LINE_AA);
    }
  }
  return picture;
}

}  // namespace waymark::calibrate

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/change_layer.hpp"

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <algorithm>
#include <array>

namespace waymark::viewer {
namespace {

constexpr int kWidth_px = 4;
constexpr double kMark_m = 0.2;  // half size of a mark: half of a marker's usual side
constexpr double kMinMark_px = 7.0;
constexpr double kOutlineDash_px = 10.0;
constexpr double kOutlineGap_px = 7.0;

void draw_box(cv::Mat& panel, cv::Point2d centre_px, double half_px, bool is_dashed) {
  const Pen pen{palette::kMoved, kWidth_px};
  const std::array<cv::Point2d, 5> corners{
      centre_px + cv::Point2d{-half_px, -half_px}, centre_px + cv::Point2d{half_px, -half_px},
      centre_px + cv::Point2d{half_px, half_px}, centre_px + cv::Point2d{-half_px, half_px},
      centre_px + cv::Point2d{-half_px, -half_px}};
  if (is_dashed)
    draw_dashed_polyline(panel, corners, pen, kOutlineDash_px, kOutlineGap_px);
  else
    draw_polyline(panel, corners, pen);
}

}  // namespace

void draw_changes(cv::Mat& panel, const MapViewport& view, std::span<const MapChange> changes) {
  const Pen pen{palette::kMoved, kWidth_px};
  const double mark_px = std::max(kMinMark_px, kMark_m * view.px_per_m);
  for (const MapChange& change : changes) {
    const cv::Point2d now = view(change.place.translation());
    const cv::Point2d before = view(change.was_at);
    const double half_px = std::max(kMinMark_px, 0.5 * change.size_m * view.px_per_m);
    switch (change.kind) {
      case MapChange::Kind::kMissing:
        draw_line(panel, now - cv::Point2d{mark_px, mark_px}, now + cv::Point2d{mark_px, mark_px},
                  pen);
        draw_line(panel, now - cv::Point2d{mark_px, -mark_px}, now + cv::Point2d{mark_px, -mark_px},
                  pen);
        break;
      case MapChange::Kind::kMoved:
      case MapChange::Kind::kSurveyOff:
        draw_line(panel, before, now, pen);
        draw_circle(panel, before, 0.5 * mark_px, pen);
        break;
      case MapChange::Kind::kNew:
        draw_circle(panel, now, mark_px, pen);
        break;
      case MapChange::Kind::kWallNew:
        draw_box(panel, now, half_px, false);
        break;
      case MapChange::Kind::kWallGone:
        draw_box(panel, now, half_px, true);
        break;
      case MapChange::Kind::kNone:
        break;
    }
  }
}

}  // namespace waymark::viewer

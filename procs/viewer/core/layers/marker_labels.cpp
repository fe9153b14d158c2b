// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/marker_labels.hpp"

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/cell_pixels.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <limits>
#include <utility>

namespace waymark::viewer {
namespace {

constexpr double kClearance_px = 4.0;  // between labels
/// Cells with a lower occupancy are open space.
constexpr int kOpenBelow_percent = 50;

/// Share of a box on the page that lies on open space.
class OpenSpace {
 public:
  OpenSpace(const GridMap& map, const MapViewport& view) {
    cv::Mat_<uchar> open(rows(view), columns(view), uchar{0});
    MapViewport coarse = view;
    coarse.px_per_m /= kCoarse;
    for_each_pixel_on_map(coarse, map, open.size(), [&](cv::Point pixel, cv::Point cell) {
      const int percent = map.occupancy_percent(cell);
      open(pixel) = percent >= 0 && percent < kOpenBelow_percent ? 1 : 0;
    });
    cv::integral(open, sums_, CV_32S);
  }

  double share(const cv::Rect2d& box_px) const {
    const auto column = [&](double x) {
      return std::clamp(static_cast<int>(x / kCoarse), 0, sums_.cols - 1);
    };
    const auto row = [&](double y) {
      return std::clamp(static_cast<int>(y / kCoarse), 0, sums_.rows - 1);
    };
    const int left = column(box_px.x), right = std::max(left, column(box_px.br().x));
    const int top = row(box_px.y), bottom = std::max(top, row(box_px.br().y));
    const int open =
        sums_(bottom, right) - sums_(bottom, left) - sums_(top, right) + sums_(top, left);
    return open * kCoarse * kCoarse / box_px.area();
  }

 private:
  static constexpr double kCoarse = 4.0;  // page pixels per pixel of the mask

  static int columns(const MapViewport& view) {
    return static_cast<int>(view.size_px().width / kCoarse) + 1;
  }

  static int rows(const MapViewport& view) {
    return static_cast<int>(view.size_px().height / kCoarse) + 1;
  }

  cv::Mat_<int> sums_;
};

cv::Rect2d grown(const cv::Rect2d& box, double by_px) {
  return {box.x - by_px, box.y - by_px, box.width + 2 * by_px, box.height + 2 * by_px};
}

struct Placer {
  const OpenSpace& open_space;
  const std::vector<cv::Rect2d>& taken;
  cv::Rect2d panel;

  /// Lower is better. Weights of the parts: area outside the panel >> area on other labels >> area
  /// on open space >> distance moved [px].
  double cost(const cv::Rect2d& box, double moved_px) const {
    constexpr double kOutside = 1e6, kOnLabel = 1e5, kOnOpenSpace = 1e3;
    double cost = moved_px;
    cost += kOutside * (1.0 - (box & panel).area() / box.area());
    for (const cv::Rect2d& other : taken)
      cost += kOnLabel * (box & other).area() / box.area();
    return cost + kOnOpenSpace * open_space.share(box);
  }

  cv::Rect2d best_box(cv::Point2d marker_px, cv::Point2d behind, cv::Size2d size) const {
    const cv::Point2d along{-behind.y, behind.x};
    // Distance from the marker to the label's middle at which the label just clears the wall.
    const double reach_px =
        16.0 + 0.5 * (std::abs(behind.x) * size.width + std::abs(behind.y) * size.height);
    cv::Rect2d best;
    double lowest = std::numeric_limits<double>::infinity();
    for (const double side : {1.0, -1.0}) {
      for (int step_out = 0; step_out < 6; ++step_out) {
        for (const double step_along : {0.0, 0.6, -0.6, 1.2, -1.2, 1.8, -1.8}) {
          const double out_px = reach_px + 0.6 * size.height * step_out;
          const double along_px = step_along * size.width;
          const cv::Point2d middle = marker_px + side * out_px * behind + along_px * along;
          const cv::Rect2d box{middle.x - size.width / 2, middle.y - size.height / 2, size.width,
                               size.height};
          constexpr double kWrongSide_px = 150.0;
          const double moved_px =
              out_px - reach_px + std::abs(along_px) + (side < 0 ? kWrongSide_px : 0.0);
          const double value = cost(box, moved_px);
          if (value < lowest) std::tie(lowest, best) = std::pair{value, box};
        }
      }
    }
    return best;
  }
};

}  // namespace

std::string label_text(const Landmark& landmark) {
  std::string text = landmark.instance == 0 ? fmt::format("{}", landmark.id)
                                            : fmt::format("{}.{}", landmark.id, landmark.instance);
  if (landmark.state == LandmarkState::kMoved) text += " moved";
  return text;
}

cv::Scalar colour_of(LandmarkState state) {
  switch (state) {
    case LandmarkState::kConfirmed:
    case LandmarkState::kTentative:
      return palette::kMarker;
    case LandmarkState::kMoved:
      return palette::kMoved;
    case LandmarkState::kUnknown:
      break;
  }
  return palette::kFaintInk;
}

std::vector<MarkerLabel> place_labels(const std::vector<Landmark>& landmarks, const GridMap& map,
                                      const MapViewport& view, double text_height_px) {
  const OpenSpace open_space{map, view};
  const cv::Rect2d panel{cv::Point2d{0, 0}, cv::Size2d{view.size_px()}};
  std::vector<cv::Rect2d> taken;
  for (const Landmark& landmark : landmarks) {
    const cv::Point2d marker_px = view(landmark.map_from_marker.translation());
    taken.push_back(grown({marker_px.x, marker_px.y, 0, 0}, 9.0));
  }
  const Font font{.height_px = text_height_px, .colour = {}, .bold = true};
  std::vector<MarkerLabel> labels;
  for (const Landmark& landmark : landmarks) {
    const cv::Point2d marker_px = view(landmark.map_from_marker.translation());
    if (!panel.contains(marker_px)) continue;
    const std::string text = label_text(landmark);
    const cv::Size2d size{text_width_px(text, font) + 0.9 * text_height_px, 1.9 * text_height_px};
    const cv::Point2d behind = -view.direction(landmark.map_from_marker.theta());
    const cv::Rect2d box = Placer{open_space, taken, panel}.best_box(marker_px, behind, size);
    labels.push_back(
        {landmark.id, text, marker_px, box, landmark.state, colour_of(landmark.state)});
    taken.push_back(grown(box, kClearance_px));
  }
  return labels;
}

void draw_labels(cv::Mat& panel, const std::vector<MarkerLabel>& labels, double text_height_px) {
  for (const MarkerLabel& label : labels) {
    const cv::Point2d middle{label.box_px.x + label.box_px.width / 2,
                             label.box_px.y + label.box_px.height / 2};
    draw_line(panel, label.marker_px, middle, {label.colour, 2});
    const double radius_px = 0.4 * text_height_px;
    const bool is_filled = label.state != LandmarkState::kTentative;
    fill_box(panel, label.box_px, radius_px, label.colour);
    if (!is_filled) fill_box(panel, grown(label.box_px, -2.5), radius_px - 1.0, palette::kPage);
    draw_text(panel, label.text, middle, Anchor::kCentre,
              {.height_px = text_height_px,
               .colour = is_filled ? palette::text_on(label.colour) : label.colour,
               .bold = true});
  }
}

}  // namespace waymark::viewer

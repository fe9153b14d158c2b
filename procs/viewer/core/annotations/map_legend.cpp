// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/annotations/map_legend.hpp"

#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"
#include "viewer/core/layers/change_layer.hpp"
#include "viewer/core/layers/map_layers.hpp"
#include "viewer/core/layers/marker_labels.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <string>

namespace waymark::viewer {
namespace {

constexpr double kLegendText_px = 17.0;
constexpr double kFirstLine_px = 40.0;
constexpr double kLineHeight_px = 44.0;

bool has_health(const PageContent& content, Health health) {
  return std::any_of(content.estimates.begin(), content.estimates.end(),
                     [health](const EstimatedPose& pose) { return pose.health == health; });
}

bool has_state(const PageContent& content, LandmarkState state) {
  return std::any_of(content.landmarks.begin(), content.landmarks.end(),
                     [state](const Landmark& landmark) { return landmark.state == state; });
}

bool has_source(const UncertaintyMarks& marks, WeakAxisSource source) {
  return std::any_of(
      marks.weak_axes.begin(), marks.weak_axes.end(),
      [source](const EstimatedPose& pose) { return pose.weak_axis->source == source; });
}

/// Writes samples with their meaning from left to right, line by line.
class LegendWriter {
 public:
  using DrawSample = std::function<void(cv::Point2d left, cv::Point2d right)>;

  LegendWriter(cv::Mat& page, const cv::Rect& area_px)
      : page_{page}, area_px_{area_px}, x_px_(area_px.x), y_px_(area_px.y + kFirstLine_px) {}

  void add(const std::string& meaning, const DrawSample& draw_sample) {
    const Font font = fitting({.height_px = kLegendText_px, .colour = palette::kInk}, meaning,
                              area_px_.width - kSampleWidth_px - 14.0);
    const double width_px = kSampleWidth_px + 14.0 + text_width_px(meaning, font);
    if (x_px_ > area_px_.x && x_px_ + width_px > area_px_.br().x) new_line();
    draw_sample({x_px_, y_px_}, {x_px_ + kSampleWidth_px, y_px_});
    draw_text(page_, meaning, {x_px_ + kSampleWidth_px + 14.0, y_px_}, Anchor::kLeft, font);
    x_px_ += width_px + 44.0;
  }

  void add_line(const std::string& meaning, const Pen& pen) {
    add(meaning, [&](cv::Point2d left, cv::Point2d right) { draw_line(page_, left, right, pen); });
  }

  void add_box(const std::string& meaning, const cv::Scalar& colour) {
    add(meaning, [&](cv::Point2d left, cv::Point2d right) {
      const cv::Rect2d box{left.x + 10, left.y - 13, right.x - left.x - 20, 26};
      fill_box(page_, box, 4, palette::kHairline);
      fill_box(page_, {box.x + 1.5, box.y + 1.5, box.width - 3, box.height - 3}, 3, colour);
    });
  }

  /// A sample of the label beside a marker.
  void add_label(const std::string& meaning, LandmarkState state) {
    add(meaning, [&](cv::Point2d left, cv::Point2d right) {
      const cv::Rect2d box{left.x + 8, left.y - 16, right.x - left.x - 16, 32};
      draw_labels(page_,
                  {{.text = "7",
                    .marker_px = 0.5 * (left + right),
                    .box_px = box,
                    .state = state,
                    .colour = colour_of(state)}},
                  kLegendText_px);
    });
  }

  void new_line() {
    if (x_px_ <= area_px_.x) return;
    x_px_ = area_px_.x;
    y_px_ += kLineHeight_px;
  }

  int bottom_px() const {
    const double last_line_px = x_px_ > area_px_.x ? y_px_ : y_px_ - kLineHeight_px;
    return static_cast<int>(std::lround(last_line_px + kLineHeight_px));
  }

 private:
  static constexpr double kSampleWidth_px = 58.0;

  cv::Mat& page_;
  cv::Rect area_px_;
  double x_px_;
  double y_px_;
};

void add_paths(LegendWriter& legend, cv::Mat& page, const PageContent& content,
               OdometryPath odometry) {
  const StrokeWidths widths{};
  const bool has_estimate = !content.estimates.empty();
  if (has_estimate) {
    legend.add_line("estimated path, as known during the run",
                    {palette::kEstimated, widths.estimated_px});
  }
  if (!content.final_in_map.empty()) {
    legend.add("the same as known at the end", [&](cv::Point2d left, cv::Point2d right) {
      draw_dashed_polyline(page, std::array{left, right}, {palette::kFinal, widths.estimated_px},
                           kDash_px, kDashGap_px);
    });
  }
  if (!content.truth_in_map.empty()) legend.add_line("true path", {palette::kTrue, widths.true_px});
  if (!content.odometry_in_map.empty()) {
    legend.add_line(odometry == OdometryPath::kIncluded ? "odometry" : "odometry, above only",
                    {palette::kOdometry, widths.odometry_px});
  }
  if (!has_estimate) return;
  legend.add("start", [&](cv::Point2d left, cv::Point2d right) {
    draw_circle(page, 0.5 * (left + right), 11.0, {palette::kEstimated, 5});
  });
  legend.add("end", [&](cv::Point2d left, cv::Point2d right) {
    const cv::Point2d m = 0.5 * (left + right);
    fill_polygon(
        page,
        std::array<cv::Point2d, 4>{
            cv::Point2d{m.x + 20, m.y}, {m.x - 14, m.y - 14}, {m.x - 7, m.y}, {m.x - 14, m.y + 14}},
        palette::kEstimated);
  });
}

void add_marks(LegendWriter& legend, cv::Mat& page, const UncertaintyMarks& marks) {
  const std::string size = marks.magnification == 1
                               ? "true size"
                               : fmt::format("drawn {} times as large", marks.magnification);
  if (!marks.ellipses.empty()) {
    legend.add("2 sigma of the position, " + size, [&](cv::Point2d left, cv::Point2d right) {
      draw_circle(page, 0.5 * (left + right), 13.0, {palette::kEllipse, 2});
    });
  }
  std::string meaning = "weak axis of the scan (longer = weaker), the motion along it observed by ";
  for (const auto& [source, name] : {std::pair{WeakAxisSource::kOdometry, "odometry"},
                                     std::pair{WeakAxisSource::kMarkers, "markers"},
                                     std::pair{WeakAxisSource::kNothing, "nothing"},
                                     std::pair{WeakAxisSource::kUnknown, "something unknown"}}) {
    if (!has_source(marks, source)) continue;
    legend.add(meaning + name, [&page, which = source](cv::Point2d left, cv::Point2d right) {
      draw_weak_axis_bar(page, {left.x + 6, left.y}, {right.x - 6, right.y}, which, 1.0);
    });
    meaning = "by ";
  }
}

void add_health(LegendWriter& legend, const PageContent& content) {
  for (const auto& [health, name] :
       {std::pair{Health::kInitialising, "initialising"},
        std::pair{Health::kDegenerate, "degenerate: an axis unobserved"},
        std::pair{Health::kLost, "lost"}, std::pair{Health::kUnknown, "health unknown"}}) {
    if (has_health(content, health)) legend.add_box(name, colour_of(health));
  }
}

void add_markers(LegendWriter& legend, cv::Mat& page, const PageContent& content) {
  if (content.landmarks.empty()) return;
  legend.add("marker and the side that it faces", [&](cv::Point2d left, cv::Point2d right) {
    draw_line(page, {left.x + 6, left.y}, {right.x - 6, right.y}, {palette::kMarker, 7});
    draw_line(page, 0.5 * (left + right), 0.5 * (left + right) + cv::Point2d{0, 13},
              {palette::kMarker, 3});
  });
  for (const auto& [state, name] : {std::pair{LandmarkState::kConfirmed, "its id, confirmed"},
                                    std::pair{LandmarkState::kTentative, "tentative"},
                                    std::pair{LandmarkState::kMoved, "has been moved"},
                                    std::pair{LandmarkState::kUnknown, "state unknown"}}) {
    if (has_state(content, state)) legend.add_label(name, state);
  }
}

/// One entry for each kind that is on the map, with a piece of its symbol.
void add_changes(LegendWriter& legend, cv::Mat& page, const PageContent& content) {
  for (const auto& [kind, name] :
       {std::pair{MapChange::Kind::kMissing, "marker is missing"},
        std::pair{MapChange::Kind::kMoved, "where a moved marker was"},
        std::pair{MapChange::Kind::kNew, "new marker"},
        std::pair{MapChange::Kind::kSurveyOff, "where the survey has it"},
        std::pair{MapChange::Kind::kWallNew, "new wall"},
        std::pair{MapChange::Kind::kWallGone, "wall is gone"}}) {
    if (std::none_of(content.changes.begin(), content.changes.end(),
                     [which = kind](const MapChange& change) { return change.kind == which; })) {
      continue;
    }
    legend.add(name, [&page, which = kind](cv::Point2d left, cv::Point2d right) {
      const cv::Point2d middle = 0.5 * (left + right);
      const bool has_line =
          which == MapChange::Kind::kMoved || which == MapChange::Kind::kSurveyOff;
      const std::array<MapChange, 1> symbol{
          MapChange{.kind = which,
                    .place = {has_line ? right.x : middle.x, -middle.y, 0.0},
                    .was_at = {has_line ? left.x + 6 : middle.x, -middle.y},
                    .size_m = 22.0}};
      draw_changes(page, MapViewport{.px_per_m = 1.0}, symbol);
    });
  }
}

}  // namespace

int draw_legend(cv::Mat& page, const MapPage& layout, const PageContent& content,
                const UncertaintyMarks& marks) {
  LegendWriter legend{page, layout.legend_px};
  add_paths(legend, page, content, layout.odometry_in_strips);
  legend.new_line();
  add_marks(legend, page, marks);
  legend.new_line();
  add_markers(legend, page, content);
  add_changes(legend, page, content);
  add_health(legend, content);
  legend.add_box("occupied", palette::kOccupied);
  legend.add_box("free", palette::kFree);
  legend.add_box("unknown", palette::kUnknown);
  return std::min(legend.bottom_px(), page.rows);
}

}  // namespace waymark::viewer

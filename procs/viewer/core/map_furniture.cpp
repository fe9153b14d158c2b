// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/map_furniture.hpp"

#include "viewer/core/canvas.hpp"
#include "viewer/core/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <map>

namespace waymark::viewer {
namespace {

constexpr double kText_px = 17.0;

/// Cells below count as free in the heading's extent.
constexpr int kFreeBelow_percent = 50;

/// Counts free cells per bin of one cell along one axis; answers the extent of the well-filled
/// bins.
class ExtentCounter {
 public:
  void add(double position_m, double resolution_m) {
    ++counts_[static_cast<long>(std::floor(position_m / resolution_m + 1e-6))];
  }

  double extent_cells() const {
    constexpr int kStray = 3;  // bins with fewer free cells are noise
    long first = 0, last = -1;
    for (const auto& [bin, count] : counts_) {
      if (count < kStray) continue;
      if (last < first) first = bin;
      last = bin;
    }
    return static_cast<double>(last - first + 1);
  }

 private:
  std::map<long, int> counts_;
};

/// 1, 2 or 5 times a power of ten: the largest that is not longer than the limit.
double round_length(double limit) {
  const double power = std::pow(10.0, std::floor(std::log10(limit)));
  for (const double factor : {5.0, 2.0}) {
    if (factor * power <= limit) return factor * power;
  }
  return power;
}

std::string duration_text(double seconds) {
  const auto whole = static_cast<long>(std::lround(seconds));
  return whole < 60 ? fmt::format("{} s", whole)
                    : fmt::format("{} min {:02d} s", whole / 60, whole % 60);
}

double path_length_m(const std::vector<EstimatedPose>& path) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < path.size(); ++i) {
    length_m +=
        (path[i].map_from_base.translation() - path[i - 1].map_from_base.translation()).norm();
  }
  return length_m;
}

std::string summary(const PageContent& content, const Se2& view_from_map) {
  std::string text = "no map yet";
  if (const auto extent = free_extent(content.map, view_from_map)) {
    text =
        fmt::format("free space {:.2f} m long, {:.2f} m wide ({:.0f} px of {:g} m)",
                    extent->length_m, extent->width_m, extent->length_px, content.map.resolution_m);
  }
  text += fmt::format("   |   {} markers", content.landmarks.size());
  if (!content.estimates.empty()) {
    text += fmt::format(
        "   |   path {:.2f} m in {}", path_length_m(content.estimates),
        duration_text(to_seconds(content.estimates.back().time - content.estimates.front().time)));
  }
  return text;
}

bool has_health(const PageContent& content, Health health) {
  return std::any_of(content.estimates.begin(), content.estimates.end(),
                     [health](const EstimatedPose& pose) { return pose.health == health; });
}

/// Writes samples with their meaning from left to right, line by line.
class LegendWriter {
 public:
  using DrawSample = std::function<void(cv::Point2d left, cv::Point2d right)>;

  LegendWriter(cv::Mat& page, const cv::Rect& area_px)
      : page_{page}, area_px_{area_px}, x_px_(area_px.x), y_px_(area_px.y + 40.0) {}

  void add(const std::string& meaning, const DrawSample& draw_sample) {
    const Font font{.height_px = kText_px, .colour = palette::kInk};
    const double width_px = kSampleWidth_px + 14.0 + text_width_px(meaning, font);
    if (x_px_ + width_px > area_px_.br().x) new_line();
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

  void new_line() {
    x_px_ = area_px_.x;
    y_px_ += 44.0;
  }

 private:
  static constexpr double kSampleWidth_px = 58.0;

  cv::Mat& page_;
  cv::Rect area_px_;
  double x_px_;
  double y_px_;
};

void draw_scale_bar(cv::Mat& page, cv::Point2d right_end, double px_per_m) {
  const double length_m = round_length(320.0 / px_per_m);
  const double length_px = length_m * px_per_m;
  constexpr int kPieces = 4;
  for (int piece = 0; piece < kPieces; ++piece) {
    const double left = right_end.x - length_px + piece * length_px / kPieces;
    const cv::Rect2d box{left, right_end.y - 5, length_px / kPieces, 10};
    fill_box(page, box, 0, palette::kInk);
    if (piece % 2 == 1)
      fill_box(page, {box.x + 2, box.y + 2, box.width - 4, box.height - 4}, 0, palette::kPage);
  }
  draw_text(page, fmt::format("{:g} m", length_m), {right_end.x - length_px - 14, right_end.y},
            Anchor::kRight, {.height_px = kText_px, .colour = palette::kInk});
}

}  // namespace

std::optional<FreeExtent> free_extent(const GridMap& map, const Se2& view_from_map) {
  ExtentCounter along, across;
  for (int row = 0; row < map.occupancy_percent.rows; ++row) {
    for (int column = 0; column < map.occupancy_percent.cols; ++column) {
      const int percent = map.occupancy_percent(row, column);
      if (percent < 0 || percent >= kFreeBelow_percent) continue;
      // Relative to the first cell, so that unrotated cells fall in the middle of their bins.
      const Eigen::Vector2d point =
          view_from_map.rotation() * (map.cell_centre_m(row, column) - map.origin_m);
      along.add(point.x(), map.resolution_m);
      across.add(point.y(), map.resolution_m);
    }
  }
  const double length_px = along.extent_cells();
  const double width_px = across.extent_cells();
  if (length_px <= 0.0 || width_px <= 0.0) return std::nullopt;
  return FreeExtent{length_px * map.resolution_m, width_px * map.resolution_m, length_px};
}

void draw_heading(cv::Mat& page, const cv::Rect& area_px, const std::string& title,
                  const PageContent& content, const Se2& view_from_map) {
  draw_text(page, title, {area_px.x + 0.0, area_px.y + 46.0}, Anchor::kLeft,
            {.height_px = 32.0, .colour = palette::kInk, .bold = true});
  draw_text(page, summary(content, view_from_map), {area_px.x + 0.0, area_px.y + 94.0},
            Anchor::kLeft, {.height_px = 18.0, .colour = palette::kFaintInk});
}

void draw_ruler(cv::Mat& page, const Panel& panel) {
  const cv::Rect& area = panel.page_px;
  const double y = area.br().y;
  const Box& box = panel.view.box;
  const double label_step_m = round_length(std::max(2.2 * 110.0 / panel.view.px_per_m, 1e-3));
  const double tick_step_m = label_step_m / 5.0;
  draw_line(page, {area.x + 0.0, y}, {area.br().x + 0.0, y}, {palette::kFaintInk, 2});
  const auto first = static_cast<int>(std::ceil(box.left_m / tick_step_m));
  const auto last = static_cast<int>(std::floor(box.right_m / tick_step_m));
  for (int tick = first; tick <= last; ++tick) {
    const double x = area.x + panel.view.px_per_m * (tick * tick_step_m - box.left_m);
    const bool has_label = tick % 5 == 0;
    draw_line(page, {x, y}, {x, y + (has_label ? 14.0 : 7.0)}, {palette::kFaintInk, 2});
    if (!has_label) continue;
    const Font font{.height_px = 15.0, .colour = palette::kFaintInk};
    const std::string text = fmt::format("{:g} m", tick * tick_step_m);
    const double half_px = text_width_px(text, font) / 2;
    const double middle = std::clamp(x, area.x + half_px, area.br().x - half_px);
    draw_text(page, text, {middle, y + 30.0}, Anchor::kCentre, font);
  }
}

void draw_strip_marks(cv::Mat& page, const MapPage& layout) {
  const cv::Rect& overview_px = layout.overview->page_px;
  const View& overview = layout.overview->view;
  const Font font{.height_px = 17.0, .colour = palette::kFaintInk, .bold = true};
  char letter = 'A';
  for (const Panel& strip : layout.strips) {
    const double scale = overview.px_per_m;
    const double left = overview_px.x + scale * (strip.view.box.left_m - overview.box.left_m);
    const double right = overview_px.x + scale * (strip.view.box.right_m - overview.box.left_m);
    const double y = overview_px.br().y + 12.0;
    draw_line(page, {left + 4, y}, {right - 4, y}, {palette::kFaintInk, 2});
    draw_line(page, {left + 4, y - 7}, {left + 4, y}, {palette::kFaintInk, 2});
    draw_line(page, {right - 4, y - 7}, {right - 4, y}, {palette::kFaintInk, 2});
    draw_text(page, std::string(1, letter), {(left + right) / 2, y + 17.0}, Anchor::kCentre, font);
    draw_text(page, std::string(1, letter),
              {strip.page_px.x - 30.0, strip.page_px.y + strip.page_px.height / 2.0},
              Anchor::kCentre, {.height_px = 24.0, .colour = palette::kFaintInk, .bold = true});
    ++letter;
  }
}

void draw_legend(cv::Mat& page, const cv::Rect& area_px, const PageContent& content,
                 int magnification, double px_per_m) {
  LegendWriter legend{page, area_px};
  legend.add_line("estimated path", {palette::kEstimated, 3});
  if (!content.truth_in_map.empty()) legend.add_line("true path", {palette::kTrue, 8});
  if (!content.odometry_in_map.empty()) legend.add_line("odometry", {palette::kOdometry, 4});
  legend.add(magnification == 1 ? "3 sigma" : fmt::format("3 sigma, {} times", magnification),
             [&](cv::Point2d left, cv::Point2d right) {
               draw_circle(page, 0.5 * (left + right), 13.0, {palette::kEllipse, 2});
             });
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
  legend.new_line();
  legend.add("marker, its id behind the wall", [&](cv::Point2d left, cv::Point2d right) {
    draw_line(page, {left.x + 6, left.y}, {right.x - 6, right.y}, {palette::kMarker, 7});
    draw_line(page, 0.5 * (left + right), 0.5 * (left + right) + cv::Point2d{0, 13},
              {palette::kMarker, 3});
  });
  legend.add_box("occupied", palette::kOccupied);
  legend.add_box("free", palette::kFree);
  legend.add_box("unknown", palette::kUnknown);
  if (has_health(content, Health::kInitialising))
    legend.add_box("initialising", palette::kInitialising);
  if (has_health(content, Health::kDegenerate))
    legend.add_box("an axis unobserved", palette::kDegenerate);
  if (has_health(content, Health::kLost)) legend.add_box("lost", palette::kLost);
  if (has_health(content, Health::kUnknown)) legend.add_box("health unknown", palette::kNoHealth);
  draw_scale_bar(page, {area_px.br().x - 2.0, area_px.br().y - 44.0}, px_per_m);
}

}  // namespace waymark::viewer

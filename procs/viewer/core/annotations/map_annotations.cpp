// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/annotations/map_annotations.hpp"

#include "viewer/core/annotations/map_size.hpp"
#include "viewer/core/drawing/canvas.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <map>
#include <string_view>
#include <utility>

namespace waymark::viewer {
namespace {

constexpr double kText_px = 17.0;
constexpr double kScaleBar_px = 320.0;      // largest length
constexpr double kScaleBarRoom_px = 450.0;  // width of the bar with its label

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

double duration_s(const std::vector<EstimatedPose>& path) {
  return path.empty() ? 0.0 : to_seconds(path.back().time - path.front().time);
}

/// False for a path shorter than 1 s, such as that of a map file, whose poses have no times.
bool has_times(const std::vector<EstimatedPose>& path) {
  return duration_s(path) >= 1.0;
}

std::string summary(const PageContent& content, const Se2& view_from_map,
                    const MapThresholds& thresholds) {
  std::string text = size_text(content.map, view_from_map, thresholds);
  text += fmt::format("   |   {} markers", content.landmarks.size());
  if (content.estimates.empty()) return text;
  text += fmt::format("   |   path {:.2f} m", path_length_m(content.estimates));
  if (has_times(content.estimates)) text += " in " + duration_text(duration_s(content.estimates));
  return text;
}

std::string share_text(std::string_view name, std::size_t count, std::size_t of) {
  const double percent = 100.0 * static_cast<double>(count) / static_cast<double>(of);
  return percent < 0.95 ? fmt::format("{} {:.1f} %", name, percent)
                        : fmt::format("{} {:.0f} %", name, percent);
}

/// "degenerate 12 %, lost 0.4 %": the names that occur, with their shares.
template <class Kind, std::size_t N>
std::string shares_text(const std::array<std::pair<Kind, std::string_view>, N>& names,
                        const std::map<Kind, std::size_t>& counts, std::size_t of) {
  std::string text;
  for (const auto& [kind, name] : names) {
    const auto count = counts.find(kind);
    if (count == counts.end()) continue;
    text += (text.empty() ? "" : ", ") + share_text(name, count->second, of);
  }
  return text;
}

constexpr std::pair<Health, std::string_view> named(Health health) {
  return {health, name_of(health)};
}

/// Shares of the updates in each health state, and of those with a weak axis by what observed the
/// motion along it; empty without updates.
std::string health_summary(const std::vector<EstimatedPose>& estimates) {
  constexpr std::array kHealths{named(Health::kInitialising), named(Health::kTracking),
                                named(Health::kDegenerate), named(Health::kLost),
                                named(Health::kUnknown)};
  constexpr std::array<std::pair<WeakAxisSource, std::string_view>, 4> kSources{
      {{WeakAxisSource::kOdometry, "odometry"},
       {WeakAxisSource::kMarkers, "markers"},
       {WeakAxisSource::kNothing, "nothing"},
       {WeakAxisSource::kUnknown, "something unknown"}}};
  if (estimates.empty()) return "";
  std::map<Health, std::size_t> healths;
  std::map<WeakAxisSource, std::size_t> sources;
  for (const EstimatedPose& pose : estimates) {
    ++healths[pose.health];
    if (pose.weak_axis) ++sources[pose.weak_axis->source];
  }
  std::string text = "health: " + shares_text(kHealths, healths, estimates.size());
  if (!sources.empty()) {
    text += "   |   weak axis observed by " + shares_text(kSources, sources, estimates.size());
  }
  return text + " of the updates";
}

/// A line of text, in a smaller font if it would leave the area.
void draw_fitting(cv::Mat& page, const std::string& text, const cv::Rect& area_px, double y_px) {
  const Font font{.height_px = 18.0, .colour = palette::kFaintInk};
  draw_text(page, text, {area_px.x + 0.0, area_px.y + y_px}, Anchor::kLeft,
            fitting(font, text, area_px.width));
}

/// The number with as many decimals as the step has.
std::string metres_text(double at_m, double step_m) {
  const int decimals = std::max(0, -static_cast<int>(std::floor(std::log10(step_m) + 1e-9)));
  return fmt::format("{:.{}f} m", at_m, decimals);
}

/// Distance of a ruler's labels: a round length with room for the widest of them.
double label_step(const MapViewport& view, const Font& font) {
  constexpr double kRoom = 1.6;  // the first and last label are moved by half of their width
  constexpr double kLongest_m = 1e9;
  const auto has_room = [&](double step_m) {
    const double widest_px = std::max(text_width_px(metres_text(view.box.left_m, step_m), font),
                                      text_width_px(metres_text(view.box.right_m, step_m), font));
    return step_m * view.px_per_m >= kRoom * widest_px;
  };
  double limit_m = std::max(2.2 * 110.0 / view.px_per_m, 1e-3);
  while (limit_m < kLongest_m && !has_room(round_length(limit_m)))
    limit_m *= 2.0;
  return round_length(limit_m);
}

}  // namespace

void draw_heading(cv::Mat& page, const cv::Rect& area_px, const std::string& title,
                  const PageContent& content, const Se2& view_from_map,
                  const MapThresholds& thresholds) {
  const Font title_font{.height_px = 32.0, .colour = palette::kInk, .bold = true};
  draw_text(page, title, {area_px.x + 0.0, area_px.y + 46.0}, Anchor::kLeft,
            fitting(title_font, title, area_px.width - kScaleBarRoom_px));
  draw_fitting(page, summary(content, view_from_map, thresholds), area_px, 94.0);
  if (has_times(content.estimates))
    draw_fitting(page, health_summary(content.estimates), area_px, 128.0);
}

void draw_ruler(cv::Mat& page, const Panel& panel) {
  const cv::Rect& area = panel.page_px;
  const double y = area.br().y;
  const Box& box = panel.view.box;
  const Font font{.height_px = 15.0, .colour = palette::kFaintInk};
  const double label_step_m = label_step(panel.view, font);
  const double tick_step_m = label_step_m / 5.0;
  draw_line(page, {area.x + 0.0, y}, {area.br().x + 0.0, y}, {palette::kFaintInk, 2});
  const auto first = static_cast<std::int64_t>(std::ceil(box.left_m / tick_step_m));
  const auto last = static_cast<std::int64_t>(std::floor(box.right_m / tick_step_m));
  for (std::int64_t tick = first; tick <= last; ++tick) {
    const double at_m = static_cast<double>(tick) * tick_step_m;
    const double x = area.x + panel.view.px_per_m * (at_m - box.left_m);
    const bool has_label = tick % 5 == 0;
    draw_line(page, {x, y}, {x, y + (has_label ? 14.0 : 7.0)}, {palette::kFaintInk, 2});
    if (!has_label) continue;
    const std::string text = metres_text(at_m, label_step_m);
    const double half_px = text_width_px(text, font) / 2;
    const double middle = std::clamp(x, area.x + half_px, area.br().x - half_px);
    draw_text(page, text, {middle, y + 30.0}, Anchor::kCentre, font);
  }
}

void draw_strip_marks(cv::Mat& page, const MapPage& layout) {
  if (layout.strips.size() < 2) return;
  const cv::Rect& overview_px = layout.overview->page_px;
  const MapViewport& overview = layout.overview->view;
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

void draw_scale_bar(cv::Mat& page, cv::Point2d right_end_px, double px_per_m) {
  const double length_m = round_length(kScaleBar_px / px_per_m);
  const double length_px = length_m * px_per_m;
  constexpr int kPieces = 4;
  for (int piece = 0; piece < kPieces; ++piece) {
    const double left = right_end_px.x - length_px + piece * length_px / kPieces;
    const cv::Rect2d box{left, right_end_px.y - 5, length_px / kPieces, 10};
    fill_box(page, box, 0, palette::kInk);
    if (piece % 2 == 1)
      fill_box(page, {box.x + 2, box.y + 2, box.width - 4, box.height - 4}, 0, palette::kPage);
  }
  draw_text(page, fmt::format("{:g} m", length_m),
            {right_end_px.x - length_px - 14, right_end_px.y}, Anchor::kRight,
            {.height_px = kText_px, .colour = palette::kInk});
}

}  // namespace waymark::viewer

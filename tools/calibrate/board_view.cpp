// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/board_view.hpp"

#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <string_view>

namespace waymark::calibrate {
namespace {

constexpr std::size_t kMinCorners = 8;  // give 16 equations; 6 of them determine the pose
constexpr std::size_t kMinViews = 10;
constexpr std::size_t kMaxViews = 40;       // more views take seconds and improve little
constexpr double kSameView = 0.02;          // smallest move of the outline, in image widths
constexpr double kTilt_deg = 15.0;          // with less, focal length and distance are ambiguous
constexpr std::ptrdiff_t kTiltedViews = 3;  // views with at least kTilt_deg, for each axis

bool lie_in_a_line(const std::vector<cv::Point3f>& points_m) {
  const auto same_x = [&](const cv::Point3f& point) {
    return point.x == points_m[0].x;
  };
  const auto same_y = [&](const cv::Point3f& point) {
    return point.y == points_m[0].y;
  };
  return std::ranges::all_of(points_m, same_x) || std::ranges::all_of(points_m, same_y);
}

/// Sets normal and outline from the board's pose, computed with a guessed lens.
void set_geometry(BoardView& view, const cv::aruco::CharucoBoard& board, cv::Size image) {
  const double focal_px = std::max(image.width, image.height);
  const cv::Matx33d guess{focal_px, 0.0,      0.5 * (image.width - 1),  //
                          0.0,      focal_px, 0.5 * (image.height - 1), 0.0, 0.0, 1.0};
  cv::Vec3d turn;
  cv::Vec3d place_m;
  cv::solvePnP(view.corners_in_board_m, view.corners_px, guess, cv::noArray(), turn, place_m, false,
               cv::SOLVEPNP_IPPE);
  cv::Matx33d camera_from_board;
  cv::Rodrigues(turn, camera_from_board);
  view.normal = {camera_from_board(0, 2), camera_from_board(1, 2), camera_from_board(2, 2)};
  const float width_m =
      board.getSquareLength() * static_cast<float>(board.getChessboardSize().width);
  const float height_m =
      board.getSquareLength() * static_cast<float>(board.getChessboardSize().height);
  const std::vector<cv::Point3f> outline_m{
      {0.0F, 0.0F, 0.0F}, {width_m, 0.0F, 0.0F}, {width_m, height_m, 0.0F}, {0.0F, height_m, 0.0F}};
  std::vector<cv::Point2f> outline_px;
  cv::projectPoints(outline_m, turn, place_m, guess, cv::noArray(), outline_px);
  for (std::size_t k = 0; k < 4; ++k)
    view.outline[k] = cv::Point2d{outline_px[k]} / image.width;
}

/// RMS distance of the outlines' corners, in image widths.
double difference(const BoardView& a, const BoardView& b) {
  double sum = 0.0;
  for (std::size_t k = 0; k < 4; ++k) {
    const cv::Point2d step = a.outline[k] - b.outline[k];
    sum += step.dot(step);
  }
  return std::sqrt(sum / 4.0);
}

std::ptrdiff_t num_tilted(const std::vector<BoardView>& views, int axis) {
  const double least = std::sin(kTilt_deg * std::numbers::pi / 180.0);
  return std::ranges::count_if(
      views, [&](const BoardView& view) { return std::abs(view.normal[axis]) >= least; });
}

/// The ninths of the image in which no corner was seen.
std::vector<std::string_view> empty_parts(const std::vector<BoardView>& views, cv::Size image) {
  constexpr std::array<std::string_view, 9> kParts{"top left",    "top middle",    "top right",
                                                   "middle left", "centre",        "middle right",
                                                   "bottom left", "bottom middle", "bottom right"};
  std::array<bool, 9> is_seen{};
  for (const BoardView& view : views) {
    for (const cv::Point2f& corner : view.corners_px) {
      const int column =
          std::clamp(static_cast<int>(3.0F * corner.x / static_cast<float>(image.width)), 0, 2);
      const int row =
          std::clamp(static_cast<int>(3.0F * corner.y / static_cast<float>(image.height)), 0, 2);
      is_seen[static_cast<std::size_t>(3 * row + column)] = true;
    }
  }
  std::vector<std::string_view> parts;
  for (std::size_t i = 0; i < kParts.size(); ++i) {
    if (!is_seen[i]) parts.push_back(kParts[i]);
  }
  return parts;
}

}  // namespace

std::optional<BoardView> find_board(const std::string& name, const cv::Mat& gray,
                                    const cv::Ptr<cv::aruco::CharucoBoard>& board) {
  BoardCorners found = find_corners(gray, board);
  if (found.ids.size() < std::min(kMinCorners, board->chessboardCorners.size()))
    return std::nullopt;
  BoardView view{.name = name};
  view.corners_px = std::move(found.corners_px);
  for (const int id : found.ids)
    view.corners_in_board_m.push_back(board->chessboardCorners.at(static_cast<std::size_t>(id)));
  if (lie_in_a_line(view.corners_in_board_m)) return std::nullopt;
  set_geometry(view, *board, gray.size());
  return view;
}

std::vector<BoardView> different_views(const std::vector<BoardView>& views) {
  std::vector<BoardView> chosen;
  if (views.empty()) return chosen;
  std::vector<double> distances(views.size(), std::numeric_limits<double>::infinity());
  auto next = static_cast<std::size_t>(
      std::ranges::max_element(views, {}, [](const BoardView& v) { return v.corners_px.size(); }) -
      views.begin());
  while (chosen.size() < kMaxViews && distances[next] >= kSameView) {
    chosen.push_back(views[next]);
    for (std::size_t i = 0; i < views.size(); ++i)
      distances[i] = std::min(distances[i], difference(views[i], views[next]));
    next = static_cast<std::size_t>(std::ranges::max_element(distances) - distances.begin());
  }
  return chosen;
}

std::vector<std::string> missing_in(const std::vector<BoardView>& views, cv::Size image) {
  std::vector<std::string> missing;
  if (views.size() < kMinViews)
    missing.push_back(fmt::format("{} more different views of the board (there are {} of {})",
                                  kMinViews - views.size(), views.size(), kMinViews));
  if (views.empty()) return missing;
  if (const auto parts = empty_parts(views, image); !parts.empty())
    missing.push_back(
        fmt::format("the board in these parts of the image: {}", fmt::join(parts, ", ")));
  constexpr std::array<std::string_view, 2> kDirections{"left or right", "up or down"};
  for (int axis = 0; axis < 2; ++axis) {
    if (const auto count = num_tilted(views, axis); count < kTiltedViews)
      missing.push_back(fmt::format("{} more views of the board turned by {}° or more {}",
                                    kTiltedViews - count, kTilt_deg,
                                    kDirections[static_cast<std::size_t>(axis)]));
  }
  return missing;
}

}  // namespace waymark::calibrate

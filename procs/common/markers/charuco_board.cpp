// SPDX-License-Identifier: BSD-3-Clause
#include "common/markers/charuco_board.hpp"

#include "common/errors/setup_error.hpp"
#include "common/markers/marker_dictionary.hpp"

#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <charconv>
#include <limits>
#include <numbers>
#include <string_view>

namespace waymark {
namespace {

constexpr int kMinSquares = 3;   // 2 x 2 inner corners: a homography needs four points
constexpr int kMaxSquares = 60;  // along a side: bounds the memory
constexpr double kMaxSquare_m = 1.0;
constexpr int kMinHalfWindow_px = 2;  // half width of the window in which a corner is refined
constexpr int kMaxHalfWindow_px = 7;  // in larger windows, lens distortion bends the edges
constexpr int kMaxSteps = 50;
constexpr double kConverged_px = 1e-3;
// Side of a marker over that of its square: a larger marker has too little white around it to be
// found, a smaller one too few pixels to be read.
constexpr double kMinMarkerShare = 0.3;
constexpr double kMaxMarkerShare = 0.9;

/// 0 if the text is not a valid number of squares.
int number_in(std::string_view text) {
  int number{};
  const auto [stop, error] = std::from_chars(text.data(), text.data() + text.size(), number);
  const bool is_number = error == std::errc{} && stop == text.data() + text.size();
  return is_number && number >= kMinSquares && number <= kMaxSquares ? number : 0;
}

}  // namespace

cv::Ptr<cv::aruco::CharucoBoard> make_board(const BoardOptions& options) {
  const std::string_view squares{options.squares};
  const std::size_t x = squares.find('x');
  const int columns = number_in(squares.substr(0, x));
  const int rows = x == std::string::npos ? 0 : number_in(squares.substr(x + 1));
  if (columns == 0 || rows == 0)
    throw SetupError{fmt::format("--squares: got '{}', expected columns x rows, {} to {} each: 7x5",
                                 squares, kMinSquares, kMaxSquares)};
  if (!(options.square_m > 0.0 && options.square_m <= kMaxSquare_m))
    throw SetupError{fmt::format("--square-m: got {}, expected more than 0, up to {} m",
                                 options.square_m, kMaxSquare_m)};
  if (!(options.marker_m >= kMinMarkerShare * options.square_m &&
        options.marker_m <= kMaxMarkerShare * options.square_m))
    throw SetupError{fmt::format("--marker-m: got {}, expected {} to {} of --square-m {}",
                                 options.marker_m, kMinMarkerShare, kMaxMarkerShare,
                                 options.square_m)};
  const auto dictionary = find_dictionary(options.dictionary);
  if (!dictionary)
    throw SetupError{fmt::format("--dictionary: got '{}', expected one of {}", options.dictionary,
                                 fmt::join(dictionary_names(), ", "))};
  const int num_markers = columns * rows / 2;
  if (num_markers > size_of(*dictionary))
    throw SetupError{fmt::format("--squares: {} need {} markers, {} has {}", squares, num_markers,
                                 options.dictionary, size_of(*dictionary))};
  return cv::aruco::CharucoBoard::create(columns, rows, static_cast<float>(options.square_m),
                                         static_cast<float>(options.marker_m),
                                         cv::makePtr<cv::aruco::Dictionary>(*dictionary));
}

BoardCorners find_corners(const cv::Mat& gray, const cv::Ptr<cv::aruco::CharucoBoard>& board) {
  // OpenCV finds a marker and also the white square around it. Of two quads whose corners are
  // nearer than minMarkerDistanceRate times the perimeter it discards the smaller, so this must be
  // less than the distance between marker and square: half of it, to leave room for perspective.
  const auto parameters = cv::aruco::DetectorParameters::create();
  const double gap = 0.5 * (board->getSquareLength() / board->getMarkerLength() - 1.0);
  parameters->minMarkerDistanceRate =
      std::min(parameters->minMarkerDistanceRate, 0.5 * std::numbers::sqrt2 * gap / 4.0);
  BoardCorners found;
  std::vector<std::vector<cv::Point2f>> markers;
  cv::aruco::detectMarkers(gray, board->dictionary, markers, found.marker_ids, parameters);
  if (found.marker_ids.empty()) return found;
  cv::aruco::interpolateCornersCharuco(markers, found.marker_ids, gray, board, found.corners_px,
                                       found.ids);
  if (found.ids.empty()) return found;
  // OpenCV's own corners are half a pixel too far right and down (opencv issue 25539): refine them
  // here, in a window that does not reach the markers.
  double side_px = std::numeric_limits<double>::infinity();
  for (const auto& marker : markers)
    side_px = std::min(side_px, 0.25 * cv::arcLength(marker, true));
  const int half_px =
      std::clamp(static_cast<int>(gap * side_px), kMinHalfWindow_px, kMaxHalfWindow_px);
  cv::cornerSubPix(gray, found.corners_px, {half_px, half_px}, {-1, -1},
                   {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kMaxSteps, kConverged_px});
  return found;
}

}  // namespace waymark

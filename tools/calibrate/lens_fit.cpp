// SPDX-License-Identifier: BSD-3-Clause
#include "calibrate/lens_fit.hpp"

#include "common/geometry/median.hpp"

#include <Eigen/Dense>
#include <fmt/format.h>
#include <opencv2/calib3d.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace waymark::calibrate {
namespace {

constexpr int kNumLens = 9;
constexpr int kNumPose = 6;
using LensMatrix = Eigen::Matrix<double, kNumLens, kNumLens>;

constexpr double kOutlier = 3.0;        // an outlier view has more than so many median errors
constexpr double kCornerOutlier = 5.0;  // a corner, more than so many median residuals (6 sigma)
constexpr int kMaxSteps = 100;
constexpr double kConverged = 1e-10;  // relative change of the parameters

/// Covariance of the lens with the views' poses marginalised (Schur complement of the Gauss-Newton
/// Hessian). The errors of a view's corners are correlated, so only views count as independent: the
/// clustered sandwich estimator of Liang and Zeger, Biometrika 1986, with a cluster per view.
class LensInformation {
 public:
  /// @param jacobian  of projectPoints(): turn, place, focal lengths, principal point, distortion.
  void add(const cv::Mat& jacobian, const std::vector<cv::Point2f>& residuals_px) {
    Eigen::Matrix<double, Eigen::Dynamic, kNumPose + kNumLens> rows(jacobian.rows,
                                                                    kNumPose + kNumLens);
    Eigen::VectorXd errors(jacobian.rows);
    for (int row = 0; row < jacobian.rows; ++row) {
      for (int column = 0; column < rows.cols(); ++column)
        rows(row, column) = jacobian.at<double>(row, column);
      const cv::Point2f& error = residuals_px[static_cast<std::size_t>(row / 2)];
      errors(row) = row % 2 == 0 ? error.x : error.y;
    }
    const auto pose = rows.leftCols<kNumPose>();
    const auto lens = rows.rightCols<kNumLens>();
    const Eigen::MatrixXd reduced =
        lens - pose * (pose.transpose() * pose).ldlt().solve(pose.transpose() * lens);
    information_ += reduced.transpose() * reduced;
    const Eigen::Matrix<double, kNumLens, 1> score = reduced.transpose() * errors;
    scores_ += score * score.transpose();
    ++num_views_;
  }

  LensMatrix covariance() const {
    const LensMatrix inverse = information_.inverse();
    return num_views_ / (num_views_ - kNumLens) * inverse * scores_ * inverse;
  }

 private:
  LensMatrix information_{LensMatrix::Zero()};
  LensMatrix scores_{LensMatrix::Zero()};  ///< sum over the views of score * score^T
  double num_views_{0.0};
};

/// Root mean square of the mean residuals in the cells of a grid over the image: the error of the
/// lens model that all frames have in common. The remaining noise of the means makes it an upper
/// bound.
double common_error_px(const LensFit& fit, cv::Size image) {
  constexpr int kColumns = 8;
  constexpr int kRows = 6;
  std::array<cv::Point2d, kColumns * kRows> sums{};
  std::array<double, kColumns * kRows> counts{};
  double total = 0.0;
  for (std::size_t v = 0; v < fit.views.size(); ++v) {
    for (std::size_t i = 0; i < fit.residuals_px[v].size(); ++i) {
      const cv::Point2d corner = fit.views[v].corners_px[i];
      const int column =
          std::clamp(static_cast<int>(kColumns * corner.x / image.width), 0, kColumns - 1);
      const int row = std::clamp(static_cast<int>(kRows * corner.y / image.height), 0, kRows - 1);
      const auto cell = static_cast<std::size_t>(row * kColumns + column);
      sums[cell] += cv::Point2d{fit.residuals_px[v][i]};
      counts[cell] += 1.0;
      total += 1.0;
    }
  }
  double squares = 0.0;
  for (std::size_t cell = 0; cell < sums.size(); ++cell) {
    if (counts[cell] > 0.0) squares += 0.5 * sums[cell].dot(sums[cell]) / counts[cell];
  }
  return std::sqrt(squares / total);
}

LensFit fit_once(const std::vector<BoardView>& views, cv::Size image, std::vector<double>& errors) {
  std::vector<std::vector<cv::Point3f>> points_m;
  std::vector<std::vector<cv::Point2f>> points_px;
  std::size_t num_points = 0;
  for (const BoardView& view : views) {
    points_m.push_back(view.corners_in_board_m);
    points_px.push_back(view.corners_px);
    num_points += view.corners_px.size();
  }
  if (2 * num_points <= kNumLens + kNumPose * views.size())
    throw std::runtime_error{
        "more corners in each view: bring the board nearer, or take one with more squares"};
  if (views.size() <= kNumLens)
    throw std::runtime_error{fmt::format(
        "more different views of the board: {} that agree are too few for a lens of {} numbers",
        views.size(), kNumLens)};
  cv::Matx33d matrix = cv::Matx33d::eye();
  cv::Mat distortion = cv::Mat::zeros(1, 5, CV_64F);
  std::vector<cv::Mat> turns;
  std::vector<cv::Mat> places;
  LensFit fit;
  fit.views = views;
  fit.rms_px = cv::calibrateCamera(
      points_m, points_px, image, matrix, distortion, turns, places, cv::noArray(), cv::noArray(),
      errors, 0, {cv::TermCriteria::COUNT + cv::TermCriteria::EPS, kMaxSteps, kConverged});
  fit.values = {matrix(0, 0), matrix(1, 1), matrix(0, 2), matrix(1, 2)};
  for (int i = 0; i < 5; ++i)
    fit.values[static_cast<std::size_t>(4 + i)] = distortion.at<double>(i);
  LensInformation information;
  for (std::size_t v = 0; v < views.size(); ++v) {
    std::vector<cv::Point2f> residuals;
    cv::Mat jacobian;
    cv::projectPoints(points_m[v], turns[v], places[v], matrix, distortion, residuals, jacobian);
    for (std::size_t i = 0; i < residuals.size(); ++i)
      residuals[i] = points_px[v][i] - residuals[i];
    information.add(jacobian, residuals);
    fit.residuals_px.push_back(std::move(residuals));
  }
  const LensMatrix covariance = information.covariance();
  for (int i = 0; i < kNumLens; ++i)
    fit.sigmas[static_cast<std::size_t>(i)] = std::sqrt(covariance(i, i));
  return fit;
}

/// Removes corners with more than kCornerOutlier times the median residual; returns how many.
std::size_t drop_corners(std::vector<BoardView>& views,
                         const std::vector<std::vector<cv::Point2f>>& residuals_px) {
  std::vector<double> lengths_px;
  for (const auto& residuals : residuals_px) {
    for (const cv::Point2f& residual : residuals)
      lengths_px.push_back(cv::norm(residual));
  }
  const double most_px = kCornerOutlier * upper_median(std::move(lengths_px));
  std::size_t num_dropped = 0;
  for (std::size_t v = 0; v < views.size(); ++v) {
    for (std::size_t i = residuals_px[v].size(); i-- > 0;) {
      if (cv::norm(residuals_px[v][i]) <= most_px) continue;
      views[v].corners_px.erase(views[v].corners_px.begin() + std::ptrdiff_t(i));
      views[v].corners_in_board_m.erase(views[v].corners_in_board_m.begin() + std::ptrdiff_t(i));
      ++num_dropped;
    }
  }
  return num_dropped;
}

/// Removes outlier views, only the worst one before each new fit, because it distorts the errors of
/// the others; then outlier corners.
LensFit fit_without_outliers(std::vector<BoardView> views, cv::Size image) {
  std::vector<std::string> dropped;
  std::size_t num_dropped_corners = 0;
  while (true) {
    std::vector<double> errors;
    LensFit fit = fit_once(views, image, errors);
    const auto worst = std::ranges::max_element(errors) - errors.begin();
    if (errors[static_cast<std::size_t>(worst)] > kOutlier * upper_median(errors)) {
      dropped.push_back(views[static_cast<std::size_t>(worst)].name);
      views.erase(views.begin() + worst);
      continue;
    }
    const std::size_t num_corners = drop_corners(views, fit.residuals_px);
    num_dropped_corners += num_corners;
    if (num_corners > 0) continue;
    fit.dropped = std::move(dropped);
    fit.num_dropped_corners = num_dropped_corners;
    return fit;
  }
}

}  // namespace

LensFit fit_lens(const std::vector<BoardView>& views, cv::Size image) {
  try {
    LensFit fit = fit_without_outliers(views, image);
    fit.focal_sigma = std::max(fit.sigmas[0] / fit.values[0], fit.sigmas[1] / fit.values[1]);
    fit.bearing_sigma_rad = common_error_px(fit, image) / std::min(fit.values[0], fit.values[1]);
    return fit;
  } catch (const cv::Exception& error) {
    throw std::runtime_error{fmt::format("views that determine a lens: {}", error.err)};
  }
}

}  // namespace waymark::calibrate

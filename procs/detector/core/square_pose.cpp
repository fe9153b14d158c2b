// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/square_pose.hpp"

#include <Eigen/Cholesky>
#include <opencv2/calib3d.hpp>
#include <opencv2/core.hpp>

#include <array>
#include <utility>
#include <vector>

namespace waymark {
namespace {

using Vector6 = Eigen::Matrix<double, 6, 1>;
using Vector8 = Eigen::Matrix<double, 8, 1>;
using Matrix6 = Eigen::Matrix<double, 6, 6>;
using Matrix8 = Eigen::Matrix<double, 8, 8>;
using Matrix86 = Eigen::Matrix<double, 8, 6>;

constexpr double kNearestMarkerM = 0.01;

Eigen::Matrix3d cross_matrix(const Eigen::Vector3d& v) {
  return (Eigen::Matrix3d{} << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0).finished();
}

/// Observed minus predicted corners, and the derivative of the prediction with respect to a small
/// motion of the marker: (translation, rotation) in the optical frame.
struct Linearization {
  Vector8 residual_px{};
  Matrix86 jacobian{};
};

std::optional<Linearization> linearize(const Corners& seen_px, const CameraModel& camera,
                                       double size_m, const Eigen::Isometry3d& camera_from_marker) {
  Linearization result;
  const auto corners_m = corners_in_marker(size_m);
  for (int k = 0; k < 4; ++k) {
    const Eigen::Vector3d arm = camera_from_marker.linear() * corners_m[k];
    const Eigen::Vector3d point = arm + camera_from_marker.translation();
    if (!(point.z() > kNearestMarkerM)) return std::nullopt;
    const auto projection = camera.projection_jacobian(point);
    result.residual_px.segment<2>(2 * k) = seen_px[k] - camera.project(point);
    result.jacobian.block<2, 3>(2 * k, 0) = projection;
    result.jacobian.block<2, 3>(2 * k, 3) = -projection * cross_matrix(arm);
  }
  return result;
}

Eigen::Isometry3d moved(const Eigen::Isometry3d& camera_from_marker, const Vector6& motion) {
  Eigen::Isometry3d result = camera_from_marker;
  result.translation() += motion.head<3>();
  const double angle_rad = motion.tail<3>().norm();
  if (angle_rad > 0.0) {
    const Eigen::AngleAxisd turn{angle_rad, motion.tail<3>() / angle_rad};
    result.linear() = Eigen::Quaterniond{turn * camera_from_marker.linear()}.normalized().matrix();
  }
  return result;
}

/// Levenberg-Marquardt on the corners, whitened by their covariance.
class Refiner {
 public:
  Refiner(const MeasuredCorners& corners, const CameraModel& camera, double size_m)
      : seen_px_{corners.ideal_px},
        camera_{camera},
        size_m_{size_m},
        whitening_{corners.covariance} {}

  bool usable() const { return whitening_.info() == Eigen::Success; }

  Eigen::Isometry3d refine(Eigen::Isometry3d camera_from_marker) const {
    constexpr int kMaxSteps = 20;
    constexpr double kSmallStep = 1e-10;
    double damping = 1e-6;
    auto here = whitened(camera_from_marker);
    for (int step = 0; here && step < kMaxSteps; ++step) {
      Matrix6 normal = here->jacobian.transpose() * here->jacobian;
      normal.diagonal() *= 1.0 + damping;
      const Vector6 motion = normal.ldlt().solve(here->jacobian.transpose() * here->residual_px);
      const Eigen::Isometry3d next = moved(camera_from_marker, motion);
      const auto there = whitened(next);
      if (there && there->residual_px.squaredNorm() < here->residual_px.squaredNorm()) {
        camera_from_marker = next;
        here = there;
        damping *= 0.1;
      } else {
        damping = std::max(damping, 1e-4) * 10.0;
      }
      if (!(motion.norm() > kSmallStep)) break;
    }
    return camera_from_marker;
  }

  std::optional<Matrix6> covariance(const Eigen::Isometry3d& camera_from_marker) const {
    const auto here = whitened(camera_from_marker);
    if (!here) return std::nullopt;
    const Eigen::LDLT<Matrix6> information{here->jacobian.transpose() * here->jacobian};
    const Matrix6 covariance = information.solve(Matrix6::Identity());
    if (!information.isPositive() || !covariance.allFinite()) return std::nullopt;
    return 0.5 * (covariance + covariance.transpose());
  }

  std::optional<double> error_px(const Eigen::Isometry3d& camera_from_marker) const {
    const auto here = linearize(seen_px_, camera_, size_m_, camera_from_marker);
    if (!here) return std::nullopt;
    return 0.5 * here->residual_px.norm();  // root mean square over the four corners
  }

 private:
  std::optional<Linearization> whitened(const Eigen::Isometry3d& camera_from_marker) const {
    auto here = linearize(seen_px_, camera_, size_m_, camera_from_marker);
    if (!here) return std::nullopt;
    whitening_.matrixL().solveInPlace(here->residual_px);
    whitening_.matrixL().solveInPlace(here->jacobian);
    return here;
  }

  Corners seen_px_;
  const CameraModel& camera_;
  double size_m_;
  Eigen::LLT<Matrix8> whitening_;
};

Eigen::Isometry3d isometry_from_opencv(const cv::Mat& rotation_vector, const cv::Mat& translation) {
  Eigen::Isometry3d result = Eigen::Isometry3d::Identity();
  const Eigen::Vector3d turn{rotation_vector.at<double>(0), rotation_vector.at<double>(1),
                             rotation_vector.at<double>(2)};
  if (turn.norm() > 0.0) {
    result.linear() = Eigen::AngleAxisd{turn.norm(), turn.normalized()}.toRotationMatrix();
  }
  result.translation() = Eigen::Vector3d{translation.at<double>(0), translation.at<double>(1),
                                         translation.at<double>(2)};
  return result;
}

/// The two closed-form solutions; fewer when the corners are degenerate.
std::vector<Eigen::Isometry3d> closed_form_solutions(const Corners& ideal_px,
                                                     const CameraModel& camera, double size_m) {
  std::vector<cv::Point3d> object;
  std::vector<cv::Point2d> image;
  for (const Eigen::Vector3d& corner : corners_in_marker(size_m))
    object.emplace_back(corner.x(), corner.y(), corner.z());
  for (const Eigen::Vector2d& corner : ideal_px) {
    const Eigen::Vector2d ray = camera.normalized_from_ideal(corner);
    image.emplace_back(ray.x(), ray.y());
  }
  std::vector<cv::Mat> rotations;
  std::vector<cv::Mat> translations;
  cv::solvePnPGeneric(object, image, cv::Matx33d::eye(), cv::noArray(), rotations, translations,
                      false, cv::SOLVEPNP_IPPE_SQUARE);
  std::vector<Eigen::Isometry3d> solutions;
  for (std::size_t i = 0; i < rotations.size(); ++i) {
    const auto solution = isometry_from_opencv(rotations[i], translations[i]);
    if (solution.matrix().allFinite()) solutions.push_back(solution);
  }
  return solutions;
}

bool are_the_same(const Eigen::Isometry3d& a, const Eigen::Isometry3d& b) {
  constexpr double kSameAngleRad = 1e-3;
  return Eigen::Quaterniond{a.linear()}.angularDistance(Eigen::Quaterniond{b.linear()}) <
         kSameAngleRad;
}

}  // namespace

std::optional<SquarePoses> solve_square(const MeasuredCorners& corners, const CameraModel& camera,
                                        double size_m) {
  const Refiner refiner{corners, camera, size_m};
  const auto starts = closed_form_solutions(corners.ideal_px, camera, size_m);
  if (starts.size() != 2 || !refiner.usable()) return std::nullopt;

  std::array refined{refiner.refine(starts[0]), refiner.refine(starts[1])};
  // Both refinements may end in the same minimum; then the unrefined closed-form pose is `other`.
  if (are_the_same(refined[0], refined[1])) refined[1] = starts[1];

  std::array<SquarePose, 2> poses;
  for (std::size_t i = 0; i < 2; ++i) {
    const auto error_px = refiner.error_px(refined[i]);
    if (!error_px) return std::nullopt;
    poses[i] = {refined[i], *error_px};
  }
  if (poses[1].reprojection_error_px < poses[0].reprojection_error_px) {
    std::swap(poses[0], poses[1]);
  }
  const auto covariance = refiner.covariance(poses[0].camera_from_marker);
  if (!covariance) return std::nullopt;
  return SquarePoses{poses[0], poses[1], *covariance};
}

}  // namespace waymark

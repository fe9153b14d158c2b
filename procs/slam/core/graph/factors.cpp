// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/factors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace waymark {
namespace {

/// Pose of one frame in another, and how it follows steps of both (State::retract).
struct Relative {
  Eigen::Vector3d pose{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d by_from{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d by_to{Eigen::Matrix3d::Zero()};
};

Relative relative(const Se2& map_from_from, const Se2& map_from_to) {
  const Se2 from_from_to = map_from_from.inverse() * map_from_to;
  Relative result;
  result.pose << from_from_to.translation(),
      angle_difference(map_from_to.theta(), map_from_from.theta());
  result.by_to = turning(from_from_to.rotation());
  result.by_from = -carried_along(from_from_to.translation());
  return result;
}

Eigen::Vector3d vector_of(const Se2& pose) {
  return {pose.x(), pose.y(), pose.theta()};
}

Eigen::Vector3d pose_residual(Eigen::Vector3d difference) {
  difference.z() = wrap_angle(difference.z());
  return difference;
}

Variable keyframe_variable(std::size_t index) {
  return {VariableKind::kKeyframe, index};
}

}  // namespace

void State::retract(const Variable& variable, const Eigen::Ref<const Eigen::VectorXd>& step) {
  if (variable.kind == VariableKind::kCalibration) {
    calibration += step;
    return;
  }
  Se2& pose = variable.kind == VariableKind::kKeyframe ? keyframes[variable.index]
                                                       : landmarks[variable.index];
  pose = pose * along_arc(step);
}

Eigen::Matrix3d root_of(const Eigen::Matrix3d& information) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix3d> axes{information};
  return axes.eigenvalues().cwiseMax(0.0).cwiseSqrt().asDiagonal() *
         axes.eigenvectors().transpose();
}

OdometryNoise scaled(OdometryNoise noise, const OdometryScale& scale) {
  noise.along_per_sqrt_m *= scale.along;
  noise.across_per_sqrt_m *= scale.along;
  noise.turn_per_sqrt_m *= scale.turn;
  noise.turn_per_sqrt_rad *= scale.turn;
  return noise;
}

MotionKind likeliest_kind(const Eigen::Vector3d& residual, const MixtureNoise& noise) {
  struct Kind {
    MotionKind kind;
    double penalty;  // -2 log of its share: 0.95, 0.03, 0.015, 0.005
  };

  const std::array<Kind, 4> kinds{
      {{MotionKind::kRolling, 0.1},
       {residual.z() > 0.0 ? MotionKind::kLeftSpins : MotionKind::kRightSpins, 7.0},
       {MotionKind::kJerked, 8.4},
       {MotionKind::kAnything, 10.6}}};
  const auto cost = [&](const Kind& kind) {
    const Eigen::LLT<Eigen::Matrix3d> root{covariance_of(kind.kind, noise)};
    return residual.dot(root.solve(residual)) + kind.penalty +
           2.0 * Eigen::Matrix3d{root.matrixL()}.diagonal().array().log().sum();
  };
  return std::min_element(kinds.begin(), kinds.end(),
                          [&](const Kind& a, const Kind& b) { return cost(a) < cost(b); })
      ->kind;
}

Eigen::Matrix3d covariance_of(MotionKind kind, const MixtureNoise& noise) {
  constexpr double kSpinning = 25.0;  // turn by a spinning wheel, in standard deviations
  constexpr double kPushed_m = 0.1;   // while the odometry stands still
  constexpr double kPushed_rad = 0.1;
  if (kind == MotionKind::kRolling) return noise.rolling;
  if (kind == MotionKind::kJerked) return noise.rolling + 25.0 * 25.0 * noise.described;
  if (kind == MotionKind::kAnything) {
    const Eigen::Matrix3d anything =
        Eigen::Vector3d{kPushed_m, kPushed_m, kPushed_rad}.cwiseAbs2().asDiagonal();
    return noise.rolling + 125.0 * 125.0 * noise.described + anything;
  }
  // A wheel that spins is counted too far: its side is shorter than measured, and with that the
  // way.
  const bool is_left = kind == MotionKind::kLeftSpins;
  const Eigen::Vector3d spin{is_left ? -noise.half_track_m : noise.half_track_m, 0.0, 1.0};
  return noise.rolling + 9.0 * noise.described +
         kSpinning * kSpinning * noise.described(2, 2) * spin * spin.transpose();
}

Eigen::Matrix3d unmeasured_covariance(double sigma_m) {
  constexpr double kAside = 0.1;  // of the way
  constexpr double kTurn_rad_per_m = 0.2;
  return (sigma_m * Eigen::Vector3d{1.0, kAside, kTurn_rad_per_m}).cwiseAbs2().asDiagonal();
}

CorrectedMotion with_slips(CorrectedMotion moved, double distance_m, const OdometryScale& scale) {
  const Eigen::Vector2d way = moved.start_from_end.translation();
  if (way.norm() == 0.0) return moved;
  const Eigen::Vector2d along = way.normalized();
  moved.start_from_end = {Eigen::Vector2d{way + scale.slip_per_m * distance_m * along},
                          moved.start_from_end.theta()};
  moved.covariance.topLeftCorner<2, 2>() +=
      scale.slip_m2_per_m * distance_m * along * along.transpose();
  return moved;
}

CorrectedMotion OdometryFactor::moved(const State& state, const OdometryNoise& noise,
                                      const OdometryScale& scale) const {
  const CorrectedMotion moved =
      corrected_motion(motion, odometry_part(state.calibration), scaled(noise, scale));
  return is_unobserved ? with_slips(moved, motion.distance_m, scale) : moved;
}

void OdometryFactor::choose_kind(const State& state, const OdometryNoise& noise,
                                 const OdometryScale& scale) {
  if (is_cut || !noise.may_slip) return;
  const CorrectedMotion measured = moved(state, noise, scale);
  const Relative found = relative(state.keyframes[from], state.keyframes[to]);
  kind = likeliest_kind(pose_residual(found.pose - vector_of(measured.start_from_end)),
                        noise_of(measured, noise));
}

MixtureNoise OdometryFactor::noise_of(const CorrectedMotion& measured,
                                      const OdometryNoise& noise) const {
  return {measured.covariance, random_walk(motion, noise), noise.half_track_m};
}

LinearFactor OdometryFactor::linearise(const State& state, const OdometryNoise& noise,
                                       const OdometryScale& scale) const {
  const CorrectedMotion measured = moved(state, noise, scale);
  LinearFactor linear;
  const Relative found = relative(state.keyframes[from], state.keyframes[to]);
  const Eigen::Vector3d residual = pose_residual(found.pose - vector_of(measured.start_from_end));
  constexpr double kCarried_m = 1000.0;  // as good as nothing; keeps the normal equations regular
  Eigen::Matrix3d root = Eigen::Matrix3d::Identity() / kCarried_m;
  if (!is_cut) {
    const Eigen::LLT<Eigen::Matrix3d> covariance{covariance_of(kind, noise_of(measured, noise)) +
                                                 unmeasured_covariance(unmeasured_m)};
    root = covariance.matrixL().solve(Eigen::Matrix3d::Identity());
  }
  linear.residual = root * residual;
  LinearFactor::Jacobian by_calibration = LinearFactor::Jacobian::Zero(3, kCalibrationSize);
  if (!is_cut) by_calibration.leftCols<kOdometryTerms>() = -root * measured.by_errors;
  linear.blocks = {{keyframe_variable(from), root * found.by_from},
                   {keyframe_variable(to), root * found.by_to},
                   {{VariableKind::kCalibration, 0}, by_calibration}};
  return linear;
}

bool ScanFactor::normalise_shares() {
  double sum = 0.0;
  for (const Reference& reference : references)
    sum += reference.share;
  if (sum <= 0.0) return false;
  for (Reference& reference : references)
    reference.share /= sum;
  return true;
}

void ScanFactor::reweigh(const State& state) {
  constexpr double kKernel = 25.0;  // chi^2: loops are known to centimetres, submaps bend by some
  const double chi2 = linearise(state).residual.squaredNorm() / (weight * weight);
  weight = std::min(1.0, 2.0 * kKernel / (kKernel + chi2));
}

LinearFactor ScanFactor::linearise(const State& state) const {
  const Se2& map_from_keyframe = state.keyframes[keyframe];
  const Eigen::Matrix3d root = weight * root_information;
  LinearFactor linear;
  linear.blocks.reserve(references.size() + 1);
  Eigen::Matrix3d by_keyframe = Eigen::Matrix3d::Zero();
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  for (const Reference& reference : references) {
    const Se2& map_from_reference = state.keyframes[reference.keyframe];
    const Se2 expected = map_from_reference * reference.reference_from_keyframe;
    const Relative off = relative(expected, map_from_keyframe);
    residual += reference.share * off.pose;
    by_keyframe += reference.share * off.by_to;
    const Se2& to_keyframe = reference.reference_from_keyframe;
    const Eigen::Matrix3d expected_by_reference =
        turning(to_keyframe.rotation().transpose()) * carried_along(to_keyframe.translation());
    linear.blocks.push_back({keyframe_variable(reference.keyframe),
                             reference.share * root * off.by_from * expected_by_reference});
  }
  linear.residual = root * residual;
  linear.blocks.push_back({keyframe_variable(keyframe), root * by_keyframe});
  return linear;
}

LinearFactor MarkerFactor::linearise(const State& state, double gate) const {
  const Relative expected = relative(state.keyframes[keyframe], state.landmarks[landmark]);
  const Eigen::Matrix3d by_camera = measurement.by_errors_at(expected.pose.head<2>());
  LinearFactor linear;
  linear.residual =
      root_information * pose_residual(expected.pose + by_camera * camera_part(state.calibration) -
                                       vector_of(measurement.base_from_marker));
  const double chi2 = linear.residual.squaredNorm();
  const double weight = chi2 > gate ? gate / chi2 : 1.0;  // of the root: squared in the cost
  const Eigen::Matrix3d root = weight * root_information;
  linear.residual *= weight;
  LinearFactor::Jacobian by_calibration = LinearFactor::Jacobian::Zero(3, kCalibrationSize);
  by_calibration.rightCols<kCameraTerms>() = root * by_camera;
  linear.blocks = {{keyframe_variable(keyframe), root * expected.by_from},
                   {{VariableKind::kLandmark, landmark}, root * expected.by_to},
                   {{VariableKind::kCalibration, 0}, by_calibration}};
  return linear;
}

LinearFactor LandmarkPrior::linearise(const State& state) const {
  const Eigen::Matrix3d root = (is_off ? 0.0 : 1.0) * root_information;
  const Se2& found = state.landmarks[landmark];
  LinearFactor linear;
  linear.residual = root * pose_difference(found, map_from_marker);
  linear.blocks = {{{VariableKind::kLandmark, landmark}, root * turning(found.rotation())}};
  return linear;
}

LinearFactor PosePrior::linearise(const State& state) const {
  const Se2& found = state.keyframes[keyframe];
  LinearFactor linear;
  linear.residual = root_information * pose_difference(found, map_from_base);
  linear.blocks = {{keyframe_variable(keyframe), root_information * turning(found.rotation())}};
  return linear;
}

}  // namespace waymark

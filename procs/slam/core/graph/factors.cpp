// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/factors.hpp"

#include "common/geometry/squared.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// chi^2 beyond which a loop loses weight: loops are accurate to centimetres, but submaps are
// deformed by as much. 25 is 5 sigmas of one axis.
constexpr double kLoopKernel = 25.0;

// Sigma [m, rad] of disabled odometry: almost no information, yet equations with a solution.
constexpr double kDisabledSigma = 1000.0;

/// Pose of one frame in another, with its Jacobians with respect to steps of both (State::retract).
struct Relative {
  Eigen::Vector3d pose{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d jacobian_from{Eigen::Matrix3d::Zero()};
  Eigen::Matrix3d jacobian_to{Eigen::Matrix3d::Zero()};
};

Relative relative(const Se2& map_from_from, const Se2& map_from_to) {
  const Se2 from_from_to = map_from_from.inverse() * map_from_to;
  Relative result;
  result.pose << from_from_to.translation(),
      angle_difference(map_from_to.theta(), map_from_from.theta());
  result.jacobian_to = block_rotation(from_from_to.rotation());
  result.jacobian_from = -lever_arm_jacobian(from_from_to.translation());
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

CorrectedMotion OdometryFactor::moved(const State& state, const OdometryNoise& noise,
                                      const LearntOdometryNoise& learnt) const {
  return with_slips(
      corrected_motion(motion, odometry_part(state.calibration), scaled(noise, learnt)),
      motion.distance_m, hidden_slips, learnt);
}

void OdometryFactor::choose_kind(const State& state, const OdometryNoise& noise,
                                 const LearntOdometryNoise& learnt) {
  if (is_disabled || !noise.may_slip) return;
  const CorrectedMotion measured = moved(state, noise, learnt);
  const Eigen::Vector3d off = residual(state, measured);
  const MixtureNoise mixture = noise_of(measured, noise);
  const MotionKind likeliest = likeliest_kind(off, mixture);
  const bool slips = kind == MotionKind::kBothSlip &&
                     mixture_cost(kind, off, mixture) <= mixture_cost(likeliest, off, mixture);
  if (!slips) kind = likeliest;
}

Eigen::Vector3d OdometryFactor::residual(const State& state,
                                         const CorrectedMotion& measured) const {
  const Eigen::Vector3d found = relative(state.keyframes[from], state.keyframes[to]).pose;
  return pose_residual(found - vector_of(measured.start_from_end));
}

Eigen::Matrix3d OdometryFactor::root_information(const CorrectedMotion& measured,
                                                 const OdometryNoise& noise) const {
  if (is_disabled) return Eigen::Matrix3d::Identity() / kDisabledSigma;
  const Eigen::LLT<Eigen::Matrix3d> covariance{covariance_of(kind, noise_of(measured, noise)) +
                                               unmeasured_covariance(unmeasured_m)};
  return covariance.matrixL().solve(Eigen::Matrix3d::Identity());
}

MixtureNoise OdometryFactor::noise_of(const CorrectedMotion& measured,
                                      const OdometryNoise& noise) const {
  MixtureNoise mixture{measured.covariance, random_walk(motion, noise), noise.half_track_m};
  const Eigen::Vector2d step = measured.start_from_end.translation();
  if (step.norm() > 0.0) mixture.ahead = step.normalized();
  return mixture;
}

/// If the covariance of the motion were larger by D (whitened), the cost of the optimum would be
/// smaller by w' D (I + (I - H) D)^-1 w: w is the whitened residual, H its covariance.
OdometryFactor::Change OdometryFactor::best_change(const LinearFactor& linear,
                                                   const Eigen::Matrix3d& covariance,
                                                   const State& state, const OdometryNoise& noise,
                                                   const LearntOdometryNoise& learnt) const {
  Change best;
  if (is_disabled || !noise.may_slip || kind != MotionKind::kRolling) return best;
  const CorrectedMotion measured = moved(state, noise, learnt);
  const MixtureNoise mixture = noise_of(measured, noise);
  const Eigen::Matrix3d whiten = root_information(measured, noise);
  for (const MotionKind other : {MotionKind::kLeftSlips, MotionKind::kRightSlips,
                                 MotionKind::kBothSlip, MotionKind::kDisturbed}) {
    const Eigen::Matrix3d wider =
        whiten * (covariance_of(other, mixture) - mixture.rolling) * whiten.transpose();
    const Eigen::Matrix3d observed =
        Eigen::Matrix3d::Identity() + (Eigen::Matrix3d::Identity() - covariance) * wider;
    const double less = linear.residual.dot(wider * observed.inverse() * linear.residual);
    const double more = penalty(other) - penalty(kind) +
                        std::log((Eigen::Matrix3d::Identity() + wider).determinant());
    if (less - more > best.gain) best = {other, less - more};
  }
  return best;
}

double OdometryFactor::cost(const State& state, const OdometryNoise& noise,
                            const LearntOdometryNoise& learnt) const {
  const CorrectedMotion measured = moved(state, noise, learnt);
  const double chi2 = (root_information(measured, noise) * residual(state, measured)).squaredNorm();
  if (is_disabled || kind == MotionKind::kRolling) return chi2;
  const MixtureNoise mixture = noise_of(measured, noise);
  const auto cost_of = [&](MotionKind of) {
    return cost_at_zero(of, Eigen::LLT<Eigen::Matrix3d>{covariance_of(of, mixture) +
                                                        unmeasured_covariance(unmeasured_m)});
  };
  return chi2 + cost_of(kind) - cost_of(MotionKind::kRolling);
}

LinearFactor OdometryFactor::linearise(const State& state, const OdometryNoise& noise,
                                       const LearntOdometryNoise& learnt) const {
  const CorrectedMotion measured = moved(state, noise, learnt);
  LinearFactor linear;
  const Relative found = relative(state.keyframes[from], state.keyframes[to]);
  const Eigen::Matrix3d root = root_information(measured, noise);
  linear.residual = root * pose_residual(found.pose - vector_of(measured.start_from_end));
  LinearFactor::Jacobian jacobian_calibration = LinearFactor::Jacobian::Zero(3, kCalibrationSize);
  if (!is_disabled)
    jacobian_calibration.leftCols<kOdometryTerms>() = -root * measured.jacobian_calibration;
  linear.blocks = {{keyframe_variable(from), root * found.jacobian_from},
                   {keyframe_variable(to), root * found.jacobian_to},
                   {{VariableKind::kCalibration, 0}, jacobian_calibration}};
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

Eigen::Vector3d ScanFactor::residual(const State& state) const {
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  for (const Reference& reference : references) {
    const Se2 expected = state.keyframes[reference.keyframe] * reference.reference_from_keyframe;
    residual += reference.share * relative(expected, state.keyframes[keyframe]).pose;
  }
  return root_information * residual;
}

void ScanFactor::reweigh(const State& state) {
  const double chi2 = residual(state).squaredNorm();
  weight = std::min(1.0, 2.0 * kLoopKernel / (kLoopKernel + chi2));
}

double ScanFactor::cost(const State& state) const {
  return squared(weight) * residual(state).squaredNorm() + kLoopKernel * squared(1.0 - weight);
}

LinearFactor ScanFactor::linearise(const State& state) const {
  const Se2& map_from_keyframe = state.keyframes[keyframe];
  const Eigen::Matrix3d root = weight * root_information;
  LinearFactor linear;
  linear.blocks.reserve(references.size() + 1);
  Eigen::Matrix3d jacobian_keyframe = Eigen::Matrix3d::Zero();
  Eigen::Vector3d residual = Eigen::Vector3d::Zero();
  for (const Reference& reference : references) {
    const Se2& map_from_reference = state.keyframes[reference.keyframe];
    const Se2 expected = map_from_reference * reference.reference_from_keyframe;
    const Relative off = relative(expected, map_from_keyframe);
    residual += reference.share * off.pose;
    jacobian_keyframe += reference.share * off.jacobian_to;
    const Se2& to_keyframe = reference.reference_from_keyframe;
    const Eigen::Matrix3d jacobian_expected = block_rotation(to_keyframe.rotation().transpose()) *
                                              lever_arm_jacobian(to_keyframe.translation());
    linear.blocks.push_back({keyframe_variable(reference.keyframe),
                             reference.share * root * off.jacobian_from * jacobian_expected});
  }
  linear.residual = root * residual;
  linear.blocks.push_back({keyframe_variable(keyframe), root * jacobian_keyframe});
  return linear;
}

LinearFactor MarkerFactor::linearise(const State& state, double gate) const {
  const Relative expected = relative(state.keyframes[keyframe], state.landmarks[landmark]);
  const Eigen::Matrix3d jacobian_camera =
      measurement.jacobian_calibration_at(expected.pose.head<2>());
  LinearFactor linear;
  linear.residual = root_information *
                    pose_residual(expected.pose + jacobian_camera * camera_part(state.calibration) -
                                  vector_of(measurement.base_from_marker));
  const double chi2 = linear.residual.squaredNorm();
  const double weight = chi2 > gate ? gate / chi2 : 1.0;  // of the root: squared in the cost
  const Eigen::Matrix3d root = weight * root_information;
  linear.residual *= weight;
  LinearFactor::Jacobian jacobian_calibration = LinearFactor::Jacobian::Zero(3, kCalibrationSize);
  jacobian_calibration.rightCols<kCameraTerms>() = root * jacobian_camera;
  linear.blocks = {{keyframe_variable(keyframe), root * expected.jacobian_from},
                   {{VariableKind::kLandmark, landmark}, root * expected.jacobian_to},
                   {{VariableKind::kCalibration, 0}, jacobian_calibration}};
  return linear;
}

LinearFactor LandmarkPrior::linearise(const State& state) const {
  const Eigen::Matrix3d root = (is_off ? 0.0 : 1.0) * root_information;
  const Se2& found = state.landmarks[landmark];
  LinearFactor linear;
  linear.residual = root * pose_difference(found, map_from_marker);
  linear.blocks = {{{VariableKind::kLandmark, landmark}, root * block_rotation(found.rotation())}};
  return linear;
}

LinearFactor PosePrior::linearise(const State& state) const {
  const Se2& found = state.keyframes[keyframe];
  LinearFactor linear;
  linear.residual = root_information * pose_difference(found, map_from_base);
  linear.blocks = {
      {keyframe_variable(keyframe), root_information * block_rotation(found.rotation())}};
  return linear;
}

}  // namespace waymark

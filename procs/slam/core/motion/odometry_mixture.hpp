// SPDX-License-Identifier: BSD-3-Clause
// Random errors of odometry: while the wheels roll or slip, and after pushes.
#pragma once

#include "slam/core/motion/motion.hpp"
#include "slam/core/motion/odometry_errors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <cstdint>
#include <span>

namespace waymark {

/// Learnt noise of the odometry: factors on the configured standard deviations, and the mean and
/// variance that slip adds along the path where neither markers nor walls observe it.
struct LearntOdometryNoise {
  double along{1.0};          ///< factor on the standard deviations of the position
  double turn{1.0};           ///< factor on the standard deviations of the heading
  double slip_per_m{0.0};     ///< mean of (true - measured distance); negative: wheels spin
  double slip_m2_per_m{0.0};  ///< variance that slips add along the path
  double slip_m2{0.0};        ///< mean square of one slip
};

/// The noise with its standard deviations multiplied by the learnt factors.
OdometryNoise scaled(OdometryNoise noise, const LearntOdometryNoise& learnt);

/// Share (0..1) of a motion's slips that remain unobserved although known markers are sighted at
/// its end: 1 without markers, near 0 where their standard deviation along the path is small
/// compared with a slip, 0 without translation. Observed slips are modelled by MotionKind.
/// @param places  covariances [m^2] of the markers' measured positions, base axes at the end.
double hidden_share(const Motion& motion, std::span<const Eigen::Matrix2d> places,
                    const LearntOdometryNoise& learnt);

/// Adds mean and variance of unobserved slips to a measured motion.
/// @param share  of the slips that nothing observes, 0..1 (hidden_share()).
CorrectedMotion with_slips(CorrectedMotion moved, double distance_m, double share,
                           const LearntOdometryNoise& learnt);

/// Components of the odometry's noise, a mixture of normal distributions of which each factor uses
/// the likeliest one (Olson and Agarwal 2013, "Inference on networks of mixtures").
enum class MotionKind : std::uint8_t {
  kRolling,    ///< no slip
  kLeftSlips,  ///< the left wheel slips: distance and turn change together
  kRightSlips,
  kBothSlip,    ///< both wheels slip: the distance alone changes; proposed by best_change() only
  kDisturbed,   ///< a short slip or push during a normal drive
  kGrossError,  ///< the robot was pushed, or odometry jumped
};

/// Covariances of (x, y, theta) of a motion, in the frame at its start, while the wheels roll.
struct MixtureNoise {
  Eigen::Matrix3d rolling{Eigen::Matrix3d::Zero()};    ///< as learnt
  Eigen::Matrix3d described{Eigen::Matrix3d::Zero()};  ///< as configured: the size of slips scales
                                                       ///< with it, not with the learnt noise
  double half_track_m{0.0};                            ///< half of the distance between the wheels
  Eigen::Vector2d ahead{Eigen::Vector2d::UnitX()};     ///< direction of the motion
};

/// -2 log of a component's prior probability.
double penalty(MotionKind kind);

/// -2 log of a component's prior probability times its density at a zero residual, up to a
/// constant.
/// @param root  Cholesky factor of the covariance.
double cost_at_zero(MotionKind kind, const Eigen::LLT<Eigen::Matrix3d>& root);

/// -2 log of a component's prior probability times its density at a residual, up to a constant.
/// @param residual  observed minus measured (x, y, theta), in the frame at the start.
double mixture_cost(MotionKind kind, const Eigen::Vector3d& residual, const MixtureNoise& noise);

/// @param residual  as for mixture_cost().
MotionKind likeliest_kind(const Eigen::Vector3d& residual, const MixtureNoise& noise);

/// Covariance of one component, in the frame at the start.
Eigen::Matrix3d covariance_of(MotionKind kind, const MixtureNoise& noise);

/// Covariance of a motion that was not measured and was mostly straight ahead; axes of the base.
/// @param sigma_m  standard deviation of the distance.
Eigen::Matrix3d unmeasured_covariance(double sigma_m);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Factors of the graph: whitened residuals with their Jacobians.
#pragma once

#include "slam/core/graph/state.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/motion/motion.hpp"
#include "slam/core/motion/odometry_mixture.hpp"

#include <Eigen/Core>

#include <variant>
#include <vector>

namespace waymark {

/// A linearised factor: residual + sum of jacobian * step, whitened and robustly weighted.
struct LinearFactor {
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kCalibrationSize>;
  /// Transpose of one Jacobian times another one.
  using Product = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                kCalibrationSize, kCalibrationSize>;

  struct Block {
    Variable variable{};
    Jacobian jacobian{};
  };

  Eigen::Vector3d residual{Eigen::Vector3d::Zero()};
  std::vector<Block> blocks{};
};

/// Motion from one keyframe to the next, measured by odometry.
struct OdometryFactor {
  std::size_t from{0};
  std::size_t to{0};
  Motion motion{};
  bool is_disabled{false};   ///< the motion is unknown; a large sigma keeps the equations solvable
  double hidden_slips{0.0};  ///< share of the slips that nothing observes, see hidden_share()
  double unmeasured_m{0.0};  ///< distance that odometry may have missed (one sigma)
  MotionKind kind{MotionKind::kRolling};

  /// @param noise   as configured.
  /// @param learnt  corrections of `noise`.
  LinearFactor linearise(const State& state, const OdometryNoise& noise,
                         const LearntOdometryNoise& learnt = {}) const;

  /// Chooses the component of the mixture. The poses of `state` must be optimised for its
  /// calibration: otherwise a change of the calibration looks like a slip.
  void choose_kind(const State& state, const OdometryNoise& noise,
                   const LearntOdometryNoise& learnt);

  struct Change {
    MotionKind kind{MotionKind::kRolling};
    double gain{0.0};  ///< reduction of the graph's cost, once it is optimised
  };

  /// The component that would reduce the cost of the whole graph most; kRolling: none.
  /// @param linear      linearise() at the optimum with kRolling.
  /// @param covariance  of linear.residual, given all factors.
  Change best_change(const LinearFactor& linear, const Eigen::Matrix3d& covariance,
                     const State& state, const OdometryNoise& noise,
                     const LearntOdometryNoise& learnt) const;

  /// -2 log-likelihood up to a constant: chi^2 plus the component's penalty and log-determinant
  /// relative to kRolling's.
  double cost(const State& state, const OdometryNoise& noise,
              const LearntOdometryNoise& learnt) const;

 private:
  CorrectedMotion moved(const State& state, const OdometryNoise& noise,
                        const LearntOdometryNoise& learnt) const;
  MixtureNoise noise_of(const CorrectedMotion& measured, const OdometryNoise& noise) const;
  Eigen::Vector3d residual(const State& state, const CorrectedMotion& measured) const;
  Eigen::Matrix3d root_information(const CorrectedMotion& measured,
                                   const OdometryNoise& noise) const;
};

/// A scan matched with walls that other keyframes have observed: measures the keyframe's pose
/// relative to the weighted mean of their poses.
struct ScanFactor {
  struct Reference {
    std::size_t keyframe{0};
    double share{0.0};  ///< all shares sum to 1
    Se2 reference_from_keyframe{};
  };

  std::size_t keyframe{0};
  std::vector<Reference> references{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Zero()};  ///< base axes of `keyframe`
  bool is_loop{false};
  double weight{1.0};  ///< of a loop: robust weight, multiplies the residual; 0..1, see reweigh()

  LinearFactor linearise(const State& state) const;

  /// Scales the shares so that they sum to 1.
  /// @return false if they are all zero.
  bool normalise_shares();

  /// Dynamic covariance scaling (Agarwal et al. 2013): a loop that other factors contradict loses
  /// weight. A new loop has its full weight at first, so that the graph can move to it.
  void reweigh(const State& state);

  /// Weighted chi^2 plus the penalty of a reduced weight (Agarwal et al. 2013).
  double cost(const State& state) const;

 private:
  /// Whitened, without the weight.
  Eigen::Vector3d residual(const State& state) const;
};

/// A marker, measured from a keyframe.
struct MarkerFactor {
  std::size_t keyframe{0};
  std::size_t landmark{0};
  MarkerMeasurement measurement{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};

  /// @param gate  up to this chi^2 the factor has full weight; beyond it, (gate / chi^2)^2.
  LinearFactor linearise(const State& state, double gate) const;
};

/// Prior on a keyframe's pose: of the first keyframe, or of one that was localised in a loaded map.
struct PosePrior {
  std::size_t keyframe{0};
  Se2 map_from_base{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};

  LinearFactor linearise(const State& state) const;
};

/// Prior on a landmark's pose, from a survey.
struct LandmarkPrior {
  std::size_t landmark{0};
  Se2 map_from_marker{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};
  bool is_off{false};  ///< switched off, since the graph contradicts it

  LinearFactor linearise(const State& state) const;
};

using Factor = std::variant<OdometryFactor, ScanFactor, MarkerFactor, PosePrior, LandmarkPrior>;

/// A square root R, R' R = information; rows along the eigenvectors. Information may be singular.
Eigen::Matrix3d root_of(const Eigen::Matrix3d& information);

}  // namespace waymark

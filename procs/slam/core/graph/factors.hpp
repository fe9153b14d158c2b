// SPDX-License-Identifier: BSD-3-Clause
// What is known about the unknowns: one residual each, in standard deviations, with its Jacobians.
#pragma once

#include "slam/core/graph/state.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/motion/motion.hpp"

#include <Eigen/Core>

#include <variant>
#include <vector>

namespace waymark {

/// residual + sum of jacobian * step, whitened and robustly weighted.
struct LinearFactor {
  using Jacobian = Eigen::Matrix<double, 3, Eigen::Dynamic, Eigen::ColMajor, 3, kCalibrationSize>;
  /// Of two Jacobians.
  using Product = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor,
                                kCalibrationSize, kCalibrationSize>;

  struct Block {
    Variable variable{};
    Jacobian jacobian{};
  };

  Eigen::Vector3d residual{Eigen::Vector3d::Zero()};
  std::vector<Block> blocks{};
};

/// How much worse than configured the random walk of odometry is: factors on standard deviations,
/// and what slips add where nothing shows them.
struct OdometryScale {
  double along{1.0};
  double turn{1.0};
  double slip_per_m{0.0};     ///< mean; negative where wheels spin
  double slip_m2_per_m{0.0};  ///< variance along the way
};

/// Noise of the odometry, times the scale.
OdometryNoise scaled(OdometryNoise noise, const OdometryScale& scale);

/// The motion that the wheels measured where nothing else showed the way.
CorrectedMotion with_slips(CorrectedMotion moved, double distance_m, const OdometryScale& scale);

/// The odometry's noise is a mixture of normal distributions, of which the likeliest counts (Olson
/// and Agarwal 2013, "Inference on networks of mixtures").
enum class MotionKind : std::uint8_t {
  kRolling,
  kLeftSpins,  ///< a wheel that spins errs in the way as it errs in the turn
  kRightSpins,
  kJerked,
  kAnything,
};

/// Covariances of (x, y, theta) of a motion, in the frame at its start, while the wheels roll.
struct MixtureNoise {
  Eigen::Matrix3d rolling{Eigen::Matrix3d::Zero()};    ///< as learnt
  Eigen::Matrix3d described{Eigen::Matrix3d::Zero()};  ///< slips are measured by: bad odometry
                                                       ///< does not make them larger
  double half_track_m{0.0};                            ///< half of the distance between the wheels
};

/// @param residual  observed minus measured (x, y, theta), in the frame at the start.
MotionKind likeliest_kind(const Eigen::Vector3d& residual, const MixtureNoise& noise);

/// Of a motion of that kind.
Eigen::Matrix3d covariance_of(MotionKind kind, const MixtureNoise& noise);

/// Of a motion that was not measured: mostly ahead. Axes of the base.
/// @param sigma_m  how far that may have been.
Eigen::Matrix3d unmeasured_covariance(double sigma_m);

/// From one keyframe to the next, by the wheels.
struct OdometryFactor {
  std::size_t from{0};
  std::size_t to{0};
  Motion motion{};
  bool is_cut{false};         ///< the robot was carried: it says nothing
  bool is_unobserved{false};  ///< neither markers nor walls showed the way: wheels may have slipped
  double unmeasured_m{0.0};   ///< what may have been driven without being measured (one sigma)
  MotionKind kind{MotionKind::kRolling};

  /// @param noise  as described.
  /// @param scale  of it, as learnt.
  LinearFactor linearise(const State& state, const OdometryNoise& noise,
                         const OdometryScale& scale = {}) const;

  /// Of poses and a calibration that fit together: what the newest calibration says of poses that
  /// do not follow it yet looks like a slip.
  void choose_kind(const State& state, const OdometryNoise& noise, const OdometryScale& scale);

 private:
  CorrectedMotion moved(const State& state, const OdometryNoise& noise,
                        const OdometryScale& scale) const;
  MixtureNoise noise_of(const CorrectedMotion& measured, const OdometryNoise& noise) const;
};

/// A scan against surfaces that other keyframes have seen: the mean of what these keyframes say.
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
  /// Of a loop: how far it is believed, 0..1, on its residual; see reweigh().
  double weight{1.0};

  LinearFactor linearise(const State& state) const;

  /// Makes the shares sum to 1.
  /// @return whether there is any.
  bool normalise_shares();

  /// Dynamic covariance scaling (Agarwal et al. 2013): a loop that the others contradict loses its
  /// weight. A new one has all of it, so that the graph follows it before it is judged.
  void reweigh(const State& state);
};

/// A marker as it was measured from a keyframe.
struct MarkerFactor {
  std::size_t keyframe{0};
  std::size_t landmark{0};
  MarkerMeasurement measurement{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};

  /// Beyond `gate` (chi^2) the weight falls off with its square.
  LinearFactor linearise(const State& state, double gate) const;
};

/// A pose is known: the first one, or one of a map.
struct PosePrior {
  std::size_t keyframe{0};
  Se2 map_from_base{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};

  LinearFactor linearise(const State& state) const;
};

/// A marker's place is known, by a survey.
struct LandmarkPrior {
  std::size_t landmark{0};
  Se2 map_from_marker{};
  Eigen::Matrix3d root_information{Eigen::Matrix3d::Identity()};
  bool is_off{false};  ///< it has turned out to be wrong

  LinearFactor linearise(const State& state) const;
};

using Factor = std::variant<OdometryFactor, ScanFactor, MarkerFactor, PosePrior, LandmarkPrior>;

/// Upper triangular R with R' R = information; information may be singular.
Eigen::Matrix3d root_of(const Eigen::Matrix3d& information);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Our method: particles drawn from odometry, walls and markers fused; each with its own walls,
// markers and calibration of the odometry.
#pragma once

#include "slam/core/calibration/odometry_calibration.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/filter/particle_set.hpp"
#include "slam/core/landmark/marker_landmarks.hpp"
#include "slam/core/matching/surface_matching.hpp"
#include "slam/core/proposal/pose_proposal.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

struct WaymarkConfig {
  int particles{30};
  double resample_threshold{0.5};  ///< share of effective particles below which to resample
  double update_distance_m{0.1};   ///< scans in between are followed by odometry
  double update_turn_rad{0.0873};
  double marker_gate{16.3};          ///< chi^2 of a sighting's innovation, 3 degrees of freedom
  double same_marker_within_m{1.0};  ///< no second marker of one id nearer than this
  double scan_evidence{0.1};         ///< share of a scan's log-likelihood that weighs particles
  double lost_agreement{0.3};        ///< share of the mapped beams; below: lost
  OdometryNoise odometry{};
  SurfaceMatchingConfig matching{};
  MarkerMeasurementConfig markers{};

  void describe(Fields& fields);
};

/// FastSLAM 2.0 (Montemerlo et al., 2003) on a line-based scan matcher: each particle's pose is
/// drawn from the Gaussian that fuses its calibrated odometry, the walls it has mapped, along the
/// axes that they tell, and the markers it knows; its weight is the evidence of what was measured.
class WaymarkEstimator final : public Estimator {
 public:
  WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config);

  Estimate update(const Observation& observation) override;

  const GridMap& map() const override { return mapper_.map(); }

  std::vector<Landmark> landmarks() const override;
  std::vector<PublishedParticle> particles() const override;

  /// Of the best particle.
  const OdometryCalibration& calibration() const;

 private:
  struct State {
    State(const GridFrame& frame, const OdometryNoise& noise) : walls{frame}, calibration{noise} {}

    Se2 map_from_base{};
    Se2 previous_map_from_base{};
    SurfaceMap walls;
    MarkerLandmarks markers{};
    OdometryCalibration calibration;
  };

  /// What one particle makes of the measurements, before it moves.
  struct Step {
    PoseProposal proposal{};
    std::vector<std::pair<std::size_t, std::size_t>> known{};  ///< measurement, landmark
    std::vector<std::size_t> fresh{};                          ///< measurements of new markers
    double penalty{0.0};  ///< log weight lost to measurements that fit nothing known
    SurfaceMatch walls{};
  };

  bool is_due() const;
  void process(const Observation& observation);
  Step prepare(const State& state, const Observation& observation,
               const std::vector<MarkerMeasurement>& measurements) const;
  void associate(const State& state, const std::vector<MarkerMeasurement>& measurements,
                 Step& step) const;
  std::vector<Eigen::Vector3d> centred_normals() const;
  void move(State& state, const Se2& map_from_base, const Step& step,
            const std::vector<MarkerMeasurement>& measurements) const;
  void judge(const std::vector<Step>& steps);
  Se2 mean_pose() const;
  PoseProposal track(const Observation& observation) const;
  Estimate estimate(const Observation& observation) const;

  EstimatorSetup setup_;
  WaymarkConfig config_;
  ParticleSet<State> particles_;
  Mapper mapper_;
  Motion since_update_{};
  std::uint64_t updates_{0};

  // Of the last update:
  std::optional<State> best_{};  ///< the best particle, at the mean of its proposal
  Se2 mean_{};
  Eigen::Matrix3d covariance_{Eigen::Matrix3d::Zero()};
  double effective_particles_{1.0};
  double wall_agreement_{1.0};
  bool markers_told_{false};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Our method: particles drawn from odometry, walls and markers fused; each with its own walls,
// markers and calibration of the odometry.
#pragma once

#include "slam/core/belief/noise_growth.hpp"
#include "slam/core/belief/slip_watch.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/estimators/waymark_particle.hpp"
#include "slam/core/filter/particle_set.hpp"
#include "slam/core/landmark/kidnap_watch.hpp"
#include "slam/core/mapping/map_drift.hpp"
#include "slam/core/scan/turn_by_scans.hpp"
#include "slam/core/smoothing/retrospect.hpp"

#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

/// FastSLAM 2.0 (Montemerlo et al., 2003) on a line-based scan matcher, with delayed drawing: each
/// particle is a Gaussian over its pose, the errors of odometry and camera, and the markers. Along
/// the axes that walls can tell, the pose is drawn at each update from the fusion of odometry,
/// walls and markers, for the particle's walls are mapped from there; along the others nothing is
/// mapped that could tell later, so the Gaussian stays whole and no particles are spent on it.
/// Weights are the evidence of what was measured.
class WaymarkEstimator final : public Estimator {
 public:
  WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config);

  Estimate update(const Observation& observation) override;

  const GridMap& map() const override { return mapper_.map(); }

  std::vector<Landmark> landmarks() const override;
  std::vector<PublishedParticle> particles() const override;

  /// Smoothed: what has been learnt of the systematic errors and the markers corrects the past.
  std::vector<TimedPose> trajectory() const override;
  GridMap redrawn_map() const override;

  /// Of the best particle.
  const Belief& belief() const { return particles_.state(particles_.best()).belief; }

 private:
  enum RandomStream : std::uint64_t {
    kPoseStream = 1,
    kResamplingStream = 2,
    kStartStream = 3,
    kRestStream = 4,
    kSlipStream = 5
  };

  using Sensed = ParticleUpdate::Sensed;
  using Chance = ParticleUpdate::Chance;
  using Outcome = ParticleUpdate::Outcome;

  ParticleUpdate::Shared shared() const {
    return {config_, setup_.camera, mapper_.map(), drift_, slip_watch_};
  }

  void watch_ranges(const Observation& observation);
  void watch_calibration();
  Estimate update_by(const Observation& observation);
  void watch_standstill(const Observation& observation);
  void undo_standstill();

  /// Of a particle, as odometry has carried it since the last update.
  Se2 pose_now(std::size_t particle) const {
    return particles_.state(particle).map_from_base * since_update_.start_from_end;
  }

  std::optional<double> turn_that_contradicts_odometry(const Observation& observation) const;
  bool is_due() const;
  std::vector<MarkerMeasurement> measured(const Observation& observation) const;
  Belief belief_now() const;  ///< of the best particle, moved on by odometry
  bool is_contradicted_by(const Observation& observation) const;
  void process(const Observation& observation);
  Sensed sense(const Observation& observation);
  std::vector<Chance> draw_chances() const;
  void weigh(const std::vector<Outcome>& outcomes);
  std::optional<Eigen::Vector3d> find_slip(const Belief& expected, const Sensed& sensed) const;
  void remember(const Observation& observation);
  StaticErrors mean_errors() const;
  Statics statics() const;
  void judge(const std::vector<Outcome>& outcomes);
  Se2 mean_pose() const;
  Eigen::Matrix3d covariance_about_mean() const;
  Estimate estimate(const Observation& observation) const;

  EstimatorSetup setup_;
  WaymarkConfig config_;
  ParticleSet<WaymarkParticle> particles_;
  KidnapWatch kidnap_watch_{};
  NoiseGrowth noise_growth_{};
  SlipWatch slip_watch_{};
  OdometryNoise noise_{};  ///< the configured one, grown
  Mapper mapper_;
  MapDrift drift_{};
  Retrospect retrospect_{};
  Motion since_update_{};
  std::optional<Timestamp> stands_since_{};     ///< what the odometry tells
  std::vector<AnnotatedBeam> updated_beams_{};  ///< those of the last update
  std::uint64_t updates_{0};
  double since_ranges_told_m_{0.0};  ///< driven

  // Of the last update:
  Se2 mean_{};
  Eigen::Matrix3d covariance_{Eigen::Matrix3d::Zero()};
  double effective_particles_{1.0};
  double wall_agreement_{1.0};
  bool markers_told_{false};

  // Of the last scan:
  std::optional<double> turn_by_scans_{};  ///< [rad] more than odometry's, where that seems wrong
  bool slipped_{false};
  bool ranges_wrong_{false};
  bool calibration_widened_{false};
  KidnapWatch::Verdict verdict_{KidnapWatch::Verdict::kSettled};
};

}  // namespace waymark

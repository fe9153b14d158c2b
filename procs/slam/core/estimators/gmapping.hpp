// SPDX-License-Identifier: BSD-3-Clause
// The baseline: a Rao-Blackwellised particle filter equivalent to OpenSLAM GMapping.
#pragma once

#include "slam/core/estimators/estimator.hpp"
#include "slam/core/gmapping/motion_noise.hpp"
#include "slam/core/gmapping/published_map.hpp"
#include "slam/core/gmapping/scan_gate.hpp"
#include "slam/core/gmapping/scan_matcher.hpp"
#include "slam/core/gmapping/trajectory.hpp"
#include "slam/core/resampling/particle_set.hpp"
#include "slam/core/scan/turn_monitor.hpp"

#include <cstdint>
#include <memory>
#include <span>

namespace waymark {

/// Defaults: slam_gmapping's, whose own names begin the explanations in core_fields.cpp. Cell size
/// and seed are those of EstimatorSetup.
struct GmappingConfig {
  int particles{30};
  double max_range_m{0.0};
  double max_usable_range_m{0.0};
  double minimum_score{0.0};
  double resample_threshold{0.5};
  double likelihood_gain{3.0};
  double occupied_threshold{0.25};
  /// Where the scans contradict odometry's turn, the particles turn by the scans' estimate. An
  /// addition to the released code.
  bool watch_turns{false};
  StepNoise motion{};
  ScanGate gate{};
  MatcherConfig matcher{};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// Each particle carries a map of its beams' hits. Results do not depend on the ParallelFor.
class GmappingEstimator final : public Estimator {
 public:
  GmappingEstimator(const EstimatorSetup& setup, const GmappingConfig& config);

  Estimate update(const Observation& observation) override;

  /// The map along the best trajectory, drawn on demand; the cost depends on what has changed since
  /// the last call.
  const GridMap& map() const override;

  std::vector<Landmark> landmarks() const override { return {}; }

  std::vector<PublishedParticle> particles() const override;

  /// Trajectory of the currently best particle.
  std::vector<TimedPose> trajectory() const override;

 private:
  struct State {
    Se2 map_from_base{};
    Se2 previous_map_from_base{};
    HitMap hits{};
    Trajectory trajectory{};
    double log_likelihood{0.0};  ///< of the whole trajectory
    bool is_matched{true};       ///< the last match scored more than minimum_score
  };

  void propagate(const Motion& motion);
  void match_and_weigh(std::span<const Beam> beams);
  void resample_and_register(const std::shared_ptr<const StoredScan>& scan);
  void finalise(const Trajectory& trunk);
  StoredScan beams_in_range(const Observation& observation) const;
  Estimate estimate(const Observation& observation) const;

  EstimatorSetup setup_;
  GmappingConfig config_;
  MatcherSetting matcher_;
  ParticleSet<State> particles_;
  std::uint64_t observations_{0};
  TurnMonitor turn_monitor_{};
  ScanTrajectory scan_trajectory_{};
  std::vector<Se2> common_poses_{};  ///< at the updates that all particles share

  // Of the last update:
  std::uint64_t updates_{0};
  Timestamp updated_at_{};
  Motion since_update_{};
  std::size_t best_{0};  ///< the particle with the most likely trajectory
  Se2 map_from_best_{};  ///< its pose at that update
  double effective_particles_{1.0};
  mutable PublishedMap published_map_;  ///< a cache, determined by the trajectories
};

}  // namespace waymark

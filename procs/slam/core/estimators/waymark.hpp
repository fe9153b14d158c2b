// SPDX-License-Identifier: BSD-3-Clause
// Our method: particles drawn from odometry, walls and markers fused; each with its own walls,
// markers and calibration of the odometry.
#pragma once

#include "slam/core/belief/belief.hpp"
#include "slam/core/belief/noise_growth.hpp"
#include "slam/core/belief/slip_watch.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/filter/particle_set.hpp"
#include "slam/core/landmark/kidnap_watch.hpp"
#include "slam/core/mapping/map_drift.hpp"
#include "slam/core/matching/surface_matching.hpp"
#include "slam/core/proposal/pose_proposal.hpp"
#include "slam/core/scan/turn_by_scans.hpp"
#include "slam/core/smoothing/retrospect.hpp"
#include "slam/core/weighting/marker_score.hpp"

#include <array>
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
  double marker_near_m{0.25};        ///< off by less, it is believed, too, but counts less
  double same_marker_within_m{0.5};  ///< no second marker of one id nearer than this
  int joint_markers{48};             ///< in each particle's covariance; the others are settled
  double scan_evidence{0.1};         ///< share of a scan's log-likelihood that weighs particles
  double marker_evidence{0.02};      ///< the same of a sighting
  double evidence_knee{5.0};         ///< [nat] less than the best: half of it weighs
  /// Factor on the paper's score of the ids in the map's cells, as log weight.
  double id_layer_evidence{0.0};
  /// Markers correct each particle's pose. Else the whole pose is drawn before they are looked at,
  /// and they only weigh it.
  bool markers_in_proposal{true};
  /// Share of a pose's standard deviations that is drawn. The map drift knows the variance, and 30
  /// particles that are drawn again and again make a random walk of it.
  double drawn_spread{0.3};
  double lost_agreement{0.3};  ///< share of the mapped beams; below: lost
  OdometryNoise odometry{};
  SurfaceMatchingConfig matching{};
  MarkerMeasurementConfig markers{};

  void describe(Fields& fields);
};

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

  struct State {
    State(const GridFrame& frame, const BeliefPrior& prior) : walls{frame}, belief{prior} {}

    Se2 map_from_base{};  ///< mean of the belief
    Se2 previous_map_from_base{};
    Se2 map_from_stood{};  ///< where it was when the odometry began to stand still
    SurfaceMap walls;
    Belief belief;
  };

  /// What is the same for all particles at an update.
  struct Sensed {
    const Observation* observation{nullptr};
    std::vector<MarkerMeasurement> markers{};
    std::vector<JudgedSpot> spots{};  ///< for the map's id layer
    Observability walls{};            ///< base frame
    KidnapWatch::Verdict verdict{KidnapWatch::Verdict::kSettled};
    DriftFromWalls drift{};
    std::optional<Eigen::Vector3d> slip{};  ///< of the wheels: deviation from where odometry leads
  };

  /// What one particle draws: standard normal.
  struct Chance {
    Eigen::Vector3d pose{Eigen::Vector3d::Zero()};
    Eigen::Vector3d rest{Eigen::Vector3d::Zero()};  ///< of the pose before
    double start{0.0};                              ///< heading that matching begins with
  };

  /// What one particle made of it.
  struct Outcome {
    double log_evidence{0.0};
    int known_markers{0};
    SurfaceMatch walls{};
    PoseCorrection correction{};
    PoseError drawn{};  ///< what drawing has taken from the belief
    /// The part of it that comes from the noise of this scan and its frame.
    Eigen::Matrix3d by_noise{Eigen::Matrix3d::Zero()};
  };

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
  Outcome advance(State& state, const Sensed& sensed, const Chance& chance) const;
  void move(State& state, const Sensed& sensed) const;
  PoseProposal match_walls(const State& state, const Belief& belief, const Sensed& sensed,
                           const Eigen::Matrix3d& open, const Se2& start,
                           SurfaceMatch& match) const;
  static PoseError slip_error(const Eigen::Vector3d& slip);
  std::optional<Eigen::Vector3d> find_slip(const Belief& expected, const Sensed& sensed) const;
  void follow(State& state, const Sensed& sensed, const Chance& chance, Outcome& outcome) const;
  void correct_by_walls(State& state, const Sensed& sensed, const Eigen::Matrix3d& open,
                        double start, Outcome& outcome) const;
  void correct_by_markers(State& state, const Sensed& sensed, Outcome& outcome) const;
  void note_absences(State& state, const Sensed& sensed) const;
  void draw_rest(State& state, const Sensed& sensed, const Chance& chance) const;
  void draw(State& state, const Sensed& sensed, const PoseAxes& axes, const Chance& chance,
            Outcome& outcome) const;
  void remember(const Observation& observation);
  StaticErrors mean_errors() const;
  Statics statics() const;
  void judge(const std::vector<Outcome>& outcomes);
  Se2 mean_pose() const;
  Eigen::Matrix3d covariance_about_mean() const;
  Estimate estimate(const Observation& observation) const;

  EstimatorSetup setup_;
  WaymarkConfig config_;
  ParticleSet<State> particles_;
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

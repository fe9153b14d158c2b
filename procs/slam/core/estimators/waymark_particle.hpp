// SPDX-License-Identifier: BSD-3-Clause
// One particle of waymark, and what an update makes of it.
#pragma once

#include "slam/core/belief/belief.hpp"
#include "slam/core/belief/slip_watch.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/landmark/kidnap_watch.hpp"
#include "slam/core/mapping/map_drift.hpp"
#include "slam/core/proposal/pose_proposal.hpp"
#include "slam/core/weighting/marker_score.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// A Gaussian over pose, systematic errors and markers, and the walls that were mapped from there.
struct WaymarkParticle {
  WaymarkParticle(const GridFrame& frame, const BeliefPrior& prior) : walls{frame}, belief{prior} {}

  Se2 map_from_base{};  ///< mean of the belief
  Se2 previous_map_from_base{};
  Se2 map_from_stood{};  ///< where it was when the odometry began to stand still
  SurfaceMap walls;
  Belief belief;
};

/// The wheels are as wrong as that, in any direction.
PoseError slip_error(const Eigen::Vector3d& slip);

/// An update, to be applied to each particle. Refers to what it is given.
class ParticleUpdate {
 public:
  /// What is the same for all particles at an update.
  struct Sensed {
    const Observation* observation{nullptr};
    bool is_first{false};   ///< the robot is where the map begins
    Motion motion{};        ///< since the last update, by odometry
    OdometryNoise noise{};  ///< as it seems to be now
    std::vector<MarkerMeasurement> markers{};
    std::vector<JudgedSpot> spots{};  ///< for the map's id layer
    Observability walls{};            ///< base frame
    KidnapWatch::Verdict verdict{KidnapWatch::Verdict::kSettled};
    std::optional<Se2> returning_pose{};                   ///< after kBack
    std::optional<MarkerMeasurement> relocating_marker{};  ///< after kElsewhere
    DriftFromWalls drift{};
    std::optional<Eigen::Vector3d> slip{};  ///< of the wheels: deviation from where odometry leads
  };

  /// What one particle draws: standard normal.
  struct Chance {
    Eigen::Vector3d pose{Eigen::Vector3d::Zero()};
    Eigen::Vector3d rest{Eigen::Vector3d::Zero()};  ///< of the pose before
    double start{0.0};                              ///< heading that matching begins with
  };

  /// What one particle made of an update.
  struct Outcome {
    double log_evidence{0.0};
    int known_markers{0};
    SurfaceMatch walls{};
    PoseCorrection correction{};
    double slipped_turn_rad{0.0};  ///< of the odometry, see SlipWatch
    PoseError drawn{};             ///< what drawing has taken from the belief
    /// The part of it that comes from the noise of this scan and its frame.
    Eigen::Matrix3d by_noise{Eigen::Matrix3d::Zero()};
  };

  /// What is known beside the particles.
  struct Shared {
    const WaymarkConfig& config;
    const CameraView& camera;
    const GridMap& map;
    const MapDrift& drift;
    const SlipWatch& slip_watch;
  };

  ParticleUpdate(const Shared& shared, const Sensed& sensed)
      : shared_{shared}, config_{shared.config}, sensed_{sensed} {}

  /// By odometry, walls and markers; draws what they tell of the pose, and maps the walls from
  /// there.
  Outcome advance(WaymarkParticle& particle, const Chance& chance) const;

  /// Where a belief would be if it were held to a particle's walls.
  /// @param open  covariance of the pose that earlier updates have left, carried along by the
  /// motion.
  /// @param start  where matching begins.
  /// @param match  out: of the last step.
  PoseProposal match_walls(const WaymarkParticle& particle, const Belief& belief,
                           const Eigen::Matrix3d& open, const Se2& start,
                           SurfaceMatch& match) const;

 private:
  void follow(WaymarkParticle& particle, const Chance& chance, Outcome& outcome) const;
  void move(Belief& belief) const;
  void correct_by_walls(WaymarkParticle& particle, const Eigen::Matrix3d& open, double start,
                        Outcome& outcome) const;
  void correct_by_markers(Belief& belief, Outcome& outcome) const;
  void note_absences(Belief& belief) const;
  void draw(Belief& belief, const PoseAxes& axes, const Chance& chance, Outcome& outcome) const;
  void draw_rest(WaymarkParticle& particle, const Chance& chance) const;

  Shared shared_;
  const WaymarkConfig& config_;
  const Sensed& sensed_;
};

}  // namespace waymark

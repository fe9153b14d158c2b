// SPDX-License-Identifier: BSD-3-Clause
// Our method: a fixed-lag smoother over keyframes, markers and calibration, with loop closure.
#pragma once

#include "slam/core/association/marker_book.hpp"
#include "slam/core/association/survey.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/estimators/scan_poses.hpp"
#include "slam/core/estimators/scan_registration.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/graph/drift.hpp"
#include "slam/core/graph/graph.hpp"
#include "slam/core/graph/keyframe_thinning.hpp"
#include "slam/core/graph/loop_finder.hpp"
#include "slam/core/graph/solve_schedule.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/localisation/loaded_map.hpp"
#include "slam/core/localisation/place_finder.hpp"
#include "slam/core/localisation/relocalisation.hpp"
#include "slam/core/mapping/drawn_map.hpp"
#include "slam/core/motion/odometry_check.hpp"
#include "slam/core/odometry/odometry_noise_learner.hpp"
#include "slam/core/odometry/standstill.hpp"
#include "slam/core/odometry/unmeasured_motion.hpp"
#include "slam/core/registration/submaps.hpp"

#include <algorithm>
#include <functional>
#include <memory>
#include <optional>
#include <vector>

namespace waymark {

inline constexpr double kFirstPoseSigma = 1e-5;  ///< [m, rad]; the first pose defines the map frame
/// Consecutive keyframes in a group; one of them represents the group in scan factors.
inline constexpr std::size_t kGroupedKeyframes = 15;

/// Prior standard deviations of the calibration.
Calibration calibration_sigmas(const EstimatorSetup& setup, const WaymarkConfig& config);

class WaymarkEstimator final : public Estimator {
 public:
  WaymarkEstimator(const EstimatorSetup& setup, const WaymarkConfig& config);

  Estimate update(const Observation& measured) override;

  const GridMap& map() const override { return map_.map(); }

  std::vector<Landmark> landmarks() const override;
  std::vector<TimedPose> trajectory() const override;
  GridMap redrawn_map() const override;
  std::optional<PoseGraph> pose_graph() const override;
  std::optional<SensorStatistics> statistics() const override;
  std::optional<MapSnapshot> snapshot() const override;
  bool set_pose(const StartPose& pose) override;
  std::vector<MapChange> changes() const override;

 private:
  static constexpr double kNear_m = 12.0;  ///< landmarks nearer than this stay in the window
  static constexpr int kMaxStanding = 20;  ///< keyframes in a row while odometry stands still
  /// Keyframes of the window in a fixed map; few are enough, as the map gives each a prior.
  static constexpr std::size_t kFixedMapWindow = 16;

  /// Neighbouring keyframes that saw the walls of a match.
  struct KeyframeGroup {
    std::size_t reference{0};  ///< keyframe that represents the group in the graph
    double share{0.0};         ///< of the inliers
    std::size_t middle{0};     ///< mean keyframe, weighted by inliers
  };

  /// How the scan of a keyframe was used.
  struct KeyframeScan {
    bool is_refuted{false};         ///< the scan contradicts the map
    bool is_used{false};            ///< the scan has a factor
    bool observes_all_axes{false};  ///< the scan has a factor and observes every direction
    bool fits_loaded_map{false};    ///< likewise, with the loaded map
  };

  /// Pose at a scan that is no keyframe.
  struct BetweenKeyframes {
    Se2 map_from_base{};
    Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< given the newest keyframe; map axes
    std::optional<ScanMatch> match{};
    bool contradicts_odometry{false};
    bool observes_all_axes{false};
  };

  /// The robot stood, and then its scan contradicted the map: it was probably carried. Its pose is
  /// unknown until a marker that was mapped before, or the walls around it, are found again.
  struct Carried {
    std::size_t keyframe{0};       ///< the first one after it was put down
    std::size_t num_landmarks{0};  ///< mapped before
    NdtMap walls;                  ///< that it saw before
    Se2 map_from_walls{};
    double driven_m{0.0};  ///< since then
  };

  bool try_global_localisation(const Observation& observation);
  Estimate estimate_without_pose(const Observation& observation) const;
  void load(const std::shared_ptr<const MapSnapshot>& map);
  std::vector<Landmark> landmarks_of(const Graph& graph) const;
  const Graph& solved() const;

  bool has_map_frame() const { return survey_.is_empty() || survey_.has_map_frame(); }

  bool is_map_fixed() const { return setup_.map_mode == MapMode::kLocalise; }

  std::size_t num_window_keyframes() const {
    const auto all = static_cast<std::size_t>(config_.window_keyframes);
    return is_map_fixed() ? std::min(all, kFixedMapWindow) : all;
  }

  bool is_confirmed() const { return !loaded_map_ || loaded_map_->is_confirmed(); }

  bool is_pose_suspicious() const {
    return verdict_ == RelocalisationMonitor::Verdict::kSuspicious || relocalisation_.is_doubtful();
  }

  void follow_odometry(const Observation& observation);
  double hidden_slips(std::span<const MarkerMeasurement> measurements) const;
  void add_odometry_factor(std::size_t keyframe);
  void compare_with_odometry();
  void spread_late_motion(const Observation& observation);
  void reweigh_old_factors();
  bool is_keyframe_due(const Observation& observation) const;
  bool has_moved_without_odometry(const Se2& map_from_base) const;
  bool is_contradicted_by(const Observation& observation) const;
  bool sees_known_markers(const Observation& observation) const;
  Prediction prediction() const;
  Se2 map_from_last_scan() const;
  MapsForScan maps_for_scan() const;
  ScanAtPrediction match_at_prediction(const Observation& observation) const;
  void add_keyframe(const Observation& observation, ScanAtPrediction& scan);
  KeyframeScan add_predicted_keyframe(const Observation& observation,
                                      std::span<const MarkerMeasurement> measurements,
                                      ScanAtPrediction& scan);
  void check_pose(const Observation& observation, std::span<const MarkerMeasurement> measurements);
  void add_drift(bool has_scan_factor);
  void slide_window();
  void add_first_keyframe();
  void add_keyframe_at_commanded_pose(const StartPose& pose);
  void note_pose_given();
  void use_survey();
  void note_reason(EstimateReason reason);
  bool add_match_factor(std::size_t keyframe, const MatchedScan& scan);
  std::vector<KeyframeGroup> keyframe_groups(const ScanMatch& match, bool is_loop) const;
  bool add_scan_factor(std::size_t keyframe, const Submap& submap, const ScanMatch& match,
                       bool is_loop);
  void close_loops(const Points& points);
  void remove_redundant_keyframes();
  void step_whole_graph(const std::vector<std::size_t>& returning_landmarks);
  static std::function<Se2(std::size_t)> poses_of(const Graph& graph);
  void learn_noise(const Prediction& expected, const MatchedScan& scan);
  void learn_noise(const MarkerInnovation& innovation, const MarkerMeasurement& measurement);
  std::vector<MarkerMeasurement> measured(const Observation& observation) const;

  bool is_at_mapped_place(const MarkerInnovation& nearest, double within_if_vague_m) const;
  std::vector<PoseHint> hints(std::span<const MarkerMeasurement> measurements) const;
  void use_markers(std::span<const MarkerMeasurement> measurements);
  std::size_t new_landmark(const MarkerMeasurement& measurement, std::size_t first_new);
  std::vector<std::size_t> missed_markers(const Observation& observation,
                                          const Se2& map_from_base) const;
  void note_misses(const Observation& observation);
  void relocate(const Se2& map_from_base);
  void note_scan_after_standstill(const ScanAtPrediction& scan, const KeyframeScan& used);
  bool fits_walls_before_carry(const Points& points) const;
  void note_pose_known();
  void begin_submaps_anew();
  void map_keyframe(const Observation& observation, const Points& points);
  Estimate estimate(const Observation& observation, const Se2& map_from_base,
                    const Eigen::Matrix3d& covariance) const;
  Estimate estimate_at_keyframe(const Observation& observation) const;
  BetweenKeyframes between_keyframes(const ScanAtPrediction& scan) const;
  Estimate estimate_between(const Observation& observation, const BetweenKeyframes& between) const;
  void insert_between(const Points& points, const ScanMatch& match, const Se2& map_from_base);

  std::size_t newest() const { return graph_.state().keyframes.size() - 1; }

  EstimatorSetup setup_;
  WaymarkConfig config_;
  Graph graph_;
  MarkerBook book_{};
  RelocalisationMonitor relocalisation_{};
  /// Since when nothing shows that nobody has carried the robot: odometry stood still, or jumped.
  std::optional<Timestamp> may_be_carried_since_{};
  std::optional<Carried> carried_{};
  ScanRegistration registration_;
  OdometryNoiseLearner noise_learner_{};
  DriftCovariance drift_{};
  DriftCovariance unmatched_drift_{};  ///< the part of drift_ from keyframes without a scan factor
  LoopFinder loop_finder_;
  KeyframeThinning thinning_;
  double since_loop_search_m_{0.0};
  SolveSchedule solve_schedule_{};
  mutable std::optional<Graph> solved_{};  ///< see solved()
  Submaps submaps_;
  Motion motion_{};            ///< since the keyframe `moved_from_`
  std::size_t moved_from_{0};  ///< the newest keyframe, unless odometry was stuck
  std::optional<Standstill> standstill_{};
  int keyframes_standing_{0};  ///< in a row
  OdometryCheck odometry_check_{};
  Se2 newest_from_last_scan_{};  ///< pose of the last scan in the newest keyframe's frame
  UnmeasuredMotion unmeasured_motion_{};
  double hidden_slips_{0.0};  ///< hidden_share() of the motion to the newest keyframe
  double since_insertion_m_{0.0};
  double unobserved_m_{0.0};  ///< driven since markers or walls last observed the motion
  DrawnMap map_;
  ScanPoses scan_poses_{};
  OdometryNoise noise_of_old_factors_;  ///< odometry noise when old factors were last reweighted
  SensorStatistics statistics_{};       ///< only the counts; see statistics()

  StartPose start_;
  std::optional<PlaceFinder> place_finder_{};  ///< while it is not known where the robot started
  std::optional<LoadedMap> loaded_map_{};
  Survey survey_;
  std::optional<StartPose> commanded_pose_{};  ///< for the next keyframe
  Timestamp newest_time_{};
  double clock_s_{0.0};  ///< time since the first observation, without steps of the clock
  /// The first keyframe, a command, a new map frame or a relocalisation has just set the pose.
  bool is_pose_reset_{false};

  // Of the newest keyframe:
  RelocalisationMonitor::Verdict verdict_{RelocalisationMonitor::Verdict::kConsistent};
  double inlier_share_{1.0};
  bool markers_known_{false};
  EstimateReason reason_{EstimateReason::kOdometry};

  bool is_observed_{false};  ///< of the newest scan; see ScanPose
};

}  // namespace waymark

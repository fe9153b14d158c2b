// SPDX-License-Identifier: BSD-3-Clause
// Registers scans in the submaps of a run or in a loaded map, and monitors the LiDAR by how they
// fit.
#pragma once

#include "slam/core/estimators/sensor_statistics.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/grid/grid_map.hpp"
#include "slam/core/localisation/loaded_map.hpp"
#include "slam/core/registration/range_noise.hpp"
#include "slam/core/registration/range_scale.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/registration/submap.hpp"
#include "slam/core/registration/usual_fit.hpp"
#include "slam/core/scan/observation.hpp"

#include <Eigen/Core>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <vector>

namespace waymark {

/// A pose before its scan is used.
struct Prediction {
  Se2 map_from_base{};
  /// Given the keyframe that odometry is measured from; map axes.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
};

/// A prediction in the frame of a submap.
struct SubmapPrediction {
  Se2 submap_from_base{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< submap axes
};

SubmapPrediction in_submap(const Prediction& prediction, const Se2& map_from_submap);

/// What a scan is compared with.
struct MapsForScan {
  const GridMap& grid;               ///< as drawn so far
  const Submap* submap{nullptr};     ///< the current one; null: none has begun
  Se2 map_from_submap{};             ///< of that one
  const LoadedMap* loaded{nullptr};  ///< null: none
  bool is_fixed{false};              ///< scans are registered in the loaded map only
};

/// A scan registered in a submap or in the loaded map.
struct MatchedScan {
  ScanMatch match{};                 ///< submap frame
  const Submap* submap{nullptr};     ///< null: the loaded map, in its own frame
  const LoadedMap* loaded{nullptr};  ///< that map; null: a submap
  Se2 map_from_submap{};

  Se2 map_from_base() const { return map_from_submap * match.map_from_base; }

  /// About (x, y, theta) of map_from_base(), map axes.
  Eigen::Matrix3d information() const;

  /// Walls that the scan was matched with.
  const NdtMap& ndt() const { return submap != nullptr ? submap->ndt() : loaded->snapshot().walls; }
};

/// A scan, matched at the predicted pose.
struct ScanAtPrediction {
  Points points{};  ///< without beams that end on moving objects
  Prediction expected{};
  Prediction searched{};  ///< `expected`, with a larger covariance if odometry may be stuck
  Se2 map_from_last{};    ///< pose at the last scan
  /// Hypotheses of the motion since the last scan, see OdometryCheck.
  std::vector<Se2> steps_without_odometry{};
  double since_last_s{0.0};  ///< time since the last scan
  std::optional<MatchedScan> matched{};
  bool was_searched_widely{false};  ///< search_widely() has been called
  std::size_t beams_moving{0};      ///< number of beams excluded from the points
};

class ScanRegistration {
 public:
  /// @param range_sigma_m  as described.
  ScanRegistration(const WaymarkConfig& config, double range_sigma_m);

  /// Leaves out beams that end on moving objects, and matches the others. What is known before the
  /// match is given in `scan`: all beams in `points`, the predictions and the hypotheses.
  void match(const Observation& observation, const MapsForScan& maps, ScanAtPrediction& scan) const;

  /// If a scan fits worse than usual, the predicted pose may be outside the matcher's basin of
  /// convergence. Then wide windows are searched around that pose and around poses that do not use
  /// odometry, which are wrong by the motion since the last scan at most. Needs a matched scan.
  void search_widely(const Observation& observation, const MapsForScan& maps,
                     ScanAtPrediction& scan) const;

  /// Rescales the ranges of a scan that fits only at another scale, if that scale is accepted.
  /// @return the corrected observation; none: the measured one is used.
  std::optional<Observation> with_right_scale(const Observation& observation,
                                              const MapsForScan& maps, ScanAtPrediction& scan);

  /// Whether the ranges of the newest scan were rescaled.
  bool is_rescaled() const { return is_rescaled_; }

  /// Counts a match that the estimate uses, and learns from it.
  void note_fit(const ScanMatch& match);

  /// To be called with the match of a keyframe that was added to the graph.
  void note_keyframe(const ScanMatch& match) { usual_fit_.note_keyframe(match); }

  /// Whether the match is not refuted and has enough inliers to be used.
  bool is_usable(const ScanMatch& match) const {
    return !usual_fit_.is_refuted(match) && match.is_usable(config_);
  }

  /// Whether the match fits, and most of the scan is where the loaded map has walls.
  bool is_in_loaded_map(const ScanMatch& match) const;

  const UsualFit& usual_fit() const { return usual_fit_; }

  const RangeNoise& range_noise() const { return range_noise_; }

  /// Fills in what was counted and learnt here.
  void report(SensorStatistics& statistics) const;

 private:
  struct RescaledScan {
    double range_error{0.0};  ///< RangeScale::error of the ranges as measured
    Observation observation{};
    Points points{};
    MatchedScan matched{};
  };

  std::optional<MatchedScan> matched(const Points& points, const Prediction& prediction,
                                     const MapsForScan& maps) const;
  std::optional<RescaledScan> rescaled(const Observation& observation, const MapsForScan& maps,
                                       const ScanAtPrediction& scan) const;

  ScanMatchConfig config_;
  double min_score_;  ///< of a wide search
  UsualFit usual_fit_;
  RangeNoise range_noise_;
  RangeScaleMonitor range_scale_;
  bool is_rescaled_{false};

  // See SensorStatistics:
  std::int64_t scans_{0};
  std::int64_t scans_unusable_{0};
  std::int64_t scans_refuted_{0};
  std::int64_t scans_rescaled_{0};
  double range_scale_error_{0.0};
};

}  // namespace waymark

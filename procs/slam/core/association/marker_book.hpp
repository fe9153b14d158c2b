// SPDX-License-Identifier: BSD-3-Clause
// Data association of markers. Ids are not unique: several markers may carry the same one.
#pragma once

#include "slam/core/graph/graph.hpp"
#include "slam/core/mapping/landmark_map.hpp"

#include <functional>
#include <optional>
#include <vector>

namespace waymark {

/// A measurement compared with a landmark.
struct MarkerInnovation {
  std::size_t landmark{0};
  Eigen::Vector3d residual{Eigen::Vector3d::Zero()};    ///< measured minus expected, base frame
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};  ///< of the residual
  double chi2{0.0};

  double distance_m() const { return residual.head<2>().norm(); }
};

/// Innovation with the joint covariance of pose, landmark and camera calibration. A landmark that
/// has left the window counts as independent of the pose.
MarkerInnovation compare(const Graph& graph, std::size_t keyframe, std::size_t landmark,
                         const MarkerMeasurement& measurement);

/// map_from_marker computed from the measurement, the keyframe's pose and the calibration.
Se2 map_from_measured(const State& state, std::size_t keyframe,
                      const MarkerMeasurement& measurement);

/// Sightings and missed detections of the graph's landmarks, by landmark index.
class MarkerBook {
 public:
  const std::vector<Landmark>& entries() const { return entries_; }

  /// Adds a marker at its first sighting.
  void add(int id, Timestamp time);

  /// Adds a marker of a loaded map.
  void add_known(const Landmark& landmark);

  /// Whether the limit of added markers is reached (LandmarkMap::kMaxLandmarks): further markers
  /// would be noise or an attack, and must not be added.
  bool is_full() const { return entries_.size() - num_known_ >= LandmarkMap::kMaxLandmarks; }

  void note_sighting(std::size_t landmark, Timestamp time);

  /// To be called when the clock was set: the times of all sightings are in the new clock then.
  void set_clock(Duration later);

  /// Landmarks that should be in view and have not been sighted since `since`.
  std::vector<std::size_t> missed(
      const State& state, const Se2& map_from_base,
      const std::function<bool(const Se2& base_from_marker)>& is_in_view, Timestamp since) const;

  /// Counts a missed detection of each landmark. If another marker of the same id has appeared
  /// after the missing one was last seen, the marker was moved: its old landmark is retired.
  void note_misses(const std::vector<std::size_t>& landmarks);

  /// The retired landmark at the former place of this landmark's marker; none: it was not moved.
  std::optional<std::size_t> moved_from(std::size_t landmark) const {
    return moved_from_[landmark];
  }

  /// Numbers of the loaded map's markers that were sighted in this run.
  struct KnownMarkers {
    int in_place{0};
    int moved{0};
  };

  KnownMarkers known_markers() const;

  bool is_retired(std::size_t landmark) const { return is_retired_[landmark]; }

  bool knows(int id) const;

  /// Whether a marker is mapped within `near_m` of a place in the map.
  /// @param id  of the marker; kNoMarker: any.
  bool has_one_near(const State& state, const Eigen::Vector2d& place, double near_m,
                    int id = kNoMarker) const;

  /// The landmark of the measurement's id with the smallest chi^2.
  std::optional<MarkerInnovation> nearest(const Graph& graph, std::size_t keyframe,
                                          const MarkerMeasurement& measurement) const;

  /// The landmark of `id` that is not retired, if there is exactly one and it is confirmed.
  std::optional<std::size_t> unique(int id) const;

  /// Whether the measurement's id was misread: a confirmed marker of another id, not missed since,
  /// is mapped at the measured place, and two markers cannot share one place.
  bool is_misread(const State& state, std::size_t keyframe,
                  const MarkerMeasurement& measurement) const;

 private:
  std::size_t num_known_{0};         ///< markers of a loaded map
  std::vector<Landmark> entries_{};  ///< pose and covariance are not maintained: see Graph
  std::vector<bool> is_retired_{};
  std::vector<bool> was_sighted_{};  ///< in this run
  std::vector<std::optional<std::size_t>> moved_from_{};
};

}  // namespace waymark

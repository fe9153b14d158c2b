// SPDX-License-Identifier: BSD-3-Clause
// Data association of markers. An id is a class, not a key: several markers may carry it.
#pragma once

#include "slam/core/graph/graph.hpp"
#include "slam/core/mapping/landmark_map.hpp"

#include <functional>
#include <optional>
#include <span>
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

/// Innovation by the joint covariance of pose, landmark and camera. A landmark behind the window is
/// taken as independent of the pose.
MarkerInnovation compare(const Graph& graph, std::size_t keyframe, std::size_t landmark,
                         const MarkerMeasurement& measurement);

/// map_from_marker by the measurement, the keyframe's pose and the calibration.
Se2 map_from_measured(const State& state, std::size_t keyframe,
                      const MarkerMeasurement& measurement);

/// Sightings and misses of the graph's landmarks, by the index of a landmark.
class MarkerBook {
 public:
  const std::vector<Landmark>& entries() const { return entries_; }

  /// A marker at its first sighting.
  void add(int id, Timestamp time);

  /// A marker of a loaded map.
  void add_known(const Landmark& landmark);

  /// So many markers have been added that more are noise, or an attack: none may be added.
  bool is_full() const { return entries_.size() - num_known_ >= LandmarkMap::kMaxLandmarks; }

  void note_sighting(std::size_t landmark, Timestamp time);

  /// Counts a missed detection for every marker that should be in view and has not been sighted
  /// since `now`. A missing marker of whose id another one has appeared since was moved: its old
  /// landmark is retired.
  void note_misses(const State& state, std::size_t keyframe,
                   const std::function<bool(const Se2& base_from_marker)>& is_in_view,
                   Timestamp now);

  /// The retired landmark of the same marker, from before it was moved.
  std::optional<std::size_t> moved_from(std::size_t landmark) const {
    return moved_from_[landmark];
  }

  bool is_retired(std::size_t landmark) const { return is_retired_[landmark]; }

  bool knows(int id) const;

  /// Whether a marker hangs within `near_m` of a place.
  /// @param id  of the marker; kNoMarker: any.
  bool has_one_near(const State& state, const Eigen::Vector2d& place, double near_m,
                    int id = kNoMarker) const;

  /// The landmark of that id that fits best.
  std::optional<MarkerInnovation> nearest(const Graph& graph, std::size_t keyframe,
                                          const MarkerMeasurement& measurement) const;

  /// The landmark of that id, if there is exactly one and it is confirmed.
  std::optional<std::size_t> unique(int id) const;

  /// Whether a new id was misread: a marker of another id hangs there and is still being seen, and
  /// two markers cannot hang in one place.
  bool is_misread(const State& state, std::size_t keyframe,
                  const MarkerMeasurement& measurement) const;

 private:
  std::size_t num_known_{0};         ///< of a loaded map
  std::vector<Landmark> entries_{};  ///< pose and covariance are not set: the graph has these
  std::vector<bool> is_retired_{};
  std::vector<std::optional<std::size_t>> moved_from_{};
};

}  // namespace waymark

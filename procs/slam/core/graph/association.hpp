// SPDX-License-Identifier: BSD-3-Clause
// Which landmark a measured marker is. An id is a class, not a key: several markers may carry it.
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

/// By the joint covariance of pose, landmark and camera; a landmark behind the window counts as
/// independent of the pose.
MarkerInnovation compare(const Graph& graph, std::size_t keyframe, std::size_t landmark,
                         const MarkerMeasurement& measurement);

/// Where the marker is if the keyframe's pose and the calibration are right, map frame.
Se2 map_from_measured(const State& state, std::size_t keyframe,
                      const MarkerMeasurement& measurement);

/// The markers that are known, by the index of their landmark in the graph.
class MarkerBook {
 public:
  const std::vector<Landmark>& entries() const { return entries_; }

  /// A marker that was met for the first time.
  void add(int id, Timestamp time);

  /// One of a loaded map.
  void add_known(const Landmark& landmark);

  void note_sighting(std::size_t landmark, Timestamp time);

  /// Counts one more missed detection for every marker that should be in view and was not sighted
  /// since `now`. One that is missed while another of its id has turned up was moved: it is
  /// retired.
  void note_misses(const State& state, std::size_t keyframe,
                   const std::function<bool(const Se2& base_from_marker)>& is_in_view,
                   Timestamp now);

  /// The retired landmark that it was before it was moved.
  std::optional<std::size_t> moved_from(std::size_t landmark) const {
    return moved_from_[landmark];
  }

  bool is_retired(std::size_t landmark) const { return is_retired_[landmark]; }

  bool knows(int id) const;

  /// Some marker is known to hang within `near_m` of a place.
  /// @param id  of it; kNoMarker for any.
  bool has_one_near(const State& state, const Eigen::Vector2d& place, double near_m,
                    int id = kNoMarker) const;

  /// The landmark of that id that fits best.
  std::optional<MarkerInnovation> nearest(const Graph& graph, std::size_t keyframe,
                                          const MarkerMeasurement& measurement) const;

  /// The landmark of that id, if there is exactly one and it is confirmed.
  std::optional<std::size_t> unique(int id) const;

  /// Two markers cannot hang in one place: a new id where a known one is still being seen was
  /// misread.
  bool is_misread(const State& state, std::size_t keyframe,
                  const MarkerMeasurement& measurement) const;

 private:
  std::vector<Landmark> entries_{};  ///< without pose and covariance: the graph has these
  std::vector<bool> is_retired_{};
  std::vector<std::optional<std::size_t>> moved_from_{};
};

}  // namespace waymark

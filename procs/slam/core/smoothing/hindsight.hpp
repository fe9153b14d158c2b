// SPDX-License-Identifier: BSD-3-Clause
// The way that was driven, corrected by what has been learnt since.
#pragma once

#include "slam/core/belief/belief.hpp"
#include "slam/core/filter/scan_trail.hpp"

#include <vector>

namespace waymark {

/// What stays the same while the robot drives, as it is known at some moment.
struct Statics {
  StaticErrors errors{StaticErrors::Zero()};
  std::vector<Landmark> markers{};
};

/// Remembers at each update how the pose hung on what stays the same: the errors of odometry and
/// camera, and the markers seen last. When those are known better, so is the pose: it moves by
/// cov(pose, static) cov(static)^-1 (static now - static then), its mean given them. What a later
/// measurement tells of a past pose it tells through these, but for the odometry in between.
/// The way of a smoother without its cost: about 0.5 kB for an update.
/// Source: conditional mean of a Gaussian; Rauch, Tung, Striebel (1965), for the full smoother.
class Hindsight {
 public:
  /// @param by  of a particle; the statics are those of the whole filter.
  void add_update(const PoseByStatics& by, const Statics& then);

  /// Of the update that was added last, or of a scan that came after it.
  void add_scan(Timestamp time, const Se2& map_from_base);

  /// One pose per scan; between two updates the corrections are interpolated over time. A marker
  /// that has gone, or that is further from its place then than `same_marker_within_m` (it was
  /// moved), tells nothing.
  std::vector<TimedPose> way(const Statics& now, double same_marker_within_m) const;

  /// The same, at the updates only.
  std::vector<Se2> way_of_updates(const Statics& now, double same_marker_within_m) const;

 private:
  struct Marker {
    MarkerName name{};
    Se2 map_from_marker{};
  };

  struct Update {
    std::size_t scan{0};
    StaticErrors errors{StaticErrors::Zero()};
    std::vector<Marker> markers{};
    Eigen::Matrix<float, 3, Eigen::Dynamic> gain{};
  };

  /// Of (x, y, theta), map frame, for each update.
  std::vector<Eigen::Vector3d> corrections(const Statics& now, double same_marker_within_m) const;

  std::vector<Update> updates_{};
  std::vector<TimedPose> scans_{};
};

}  // namespace waymark

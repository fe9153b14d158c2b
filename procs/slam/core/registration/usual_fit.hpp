// SPDX-License-Identifier: BSD-3-Clause
// How well scans usually fit, and what it means if one fits worse.
#pragma once

#include "slam/core/registration/scan_match.hpp"

namespace waymark {

class UsualFit {
 public:
  /// @param min_inliers       mapped beams that a scan needs to contradict anything.
  /// @param min_inlier_share  of the mapped beams; below, the map refutes the scan.
  UsualFit(int min_inliers, double min_inlier_share)
      : min_inliers_{min_inliers}, min_inlier_share_{min_inlier_share} {}

  /// Most of what the scan shows stands where the map has something else, so that it is no view of
  /// a place that is new: the sensor is wrong, or the pose.
  bool is_refuted(const ScanMatch& match) const;

  /// Much more than usual of it stands where the map has something else: the pose may be wrong, or
  /// the ranges.
  bool is_contradicted(const ScanMatch& match) const;

  /// Less of it agrees with the map than usual: it is contradicted, or much of its view is new.
  bool is_worse_than_usual(const ScanMatch& match) const;

  /// Nearly as much of it agrees with the map as usual.
  bool is_nearly_usual(const ScanMatch& match) const;

  /// A scan that is not contradicted.
  void note_scan(const ScanMatch& match);

  /// The scan of a keyframe that was used.
  void note_keyframe(const ScanMatch& match);

 private:
  int min_inliers_;
  double min_inlier_share_;
  double inlier_share_{0.0};   ///< mean over scans
  double overall_share_{0.0};  ///< share of all beams that are inliers, mean over keyframes
};

}  // namespace waymark

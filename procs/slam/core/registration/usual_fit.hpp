// SPDX-License-Identifier: BSD-3-Clause
// Running means of how well scans fit the map, to classify scans that fit worse.
#pragma once

#include "slam/core/registration/scan_match.hpp"

namespace waymark {

class UsualFit {
 public:
  /// @param min_mapped        a scan with fewer mapped beams is neither refuted nor contradicted.
  /// @param min_inlier_share  a scan with a smaller ScanMatch::inlier_share is refuted.
  UsualFit(int min_mapped, double min_inlier_share)
      : min_mapped_{min_mapped}, min_inlier_share_{min_inlier_share} {}

  /// Most mapped beams are outliers: sensor or pose is wrong. (In a new place beams are unmapped.)
  bool is_refuted(const ScanMatch& match) const;

  /// Inliers among the mapped beams: less than kContradicted times the mean, or refuted. Pose or
  /// ranges may be wrong.
  bool is_contradicted(const ScanMatch& match) const;

  /// Inliers among the mapped beams: at least kAsUsual times the mean.
  bool is_as_usual_where_mapped(const ScanMatch& match) const;

  /// Inliers among all beams: less than kAsUsual times the mean. The scan contradicts the map, or
  /// shows a new place. is_nearly_usual() may hold as well.
  bool is_worse_than_usual(const ScanMatch& match) const;

  /// Inliers among all beams: more than kNearlyUsual times the mean.
  bool is_nearly_usual(const ScanMatch& match) const;

  /// Updates the mean share among mapped beams, with a scan that is not contradicted.
  void note_scan(const ScanMatch& match);

  /// Updates the mean share among all beams, with the scan of a keyframe that was added to the
  /// graph.
  void note_keyframe(const ScanMatch& match);

 private:
  static constexpr double kMemory = 0.05;  ///< weight of the newest scan in the running means
  static constexpr double kContradicted = 0.8;
  static constexpr double kAsUsual = 0.93;
  static constexpr double kNearlyUsual = 0.8;

  int min_mapped_;
  double min_inlier_share_;
  double inlier_share_{0.0};   ///< share of the mapped beams that are inliers, mean over scans
  double overall_share_{0.0};  ///< share of all beams that are inliers, mean over keyframes
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Running means of how well scans fit the map, to classify scans that fit worse.
#pragma once

#include "slam/core/registration/scan_match.hpp"

namespace waymark {

class UsualFit {
 public:
  /// @param min_inliers       mapped beams below which a scan is not classified.
  /// @param min_inlier_share  of the mapped beams, below which a scan is refuted.
  UsualFit(int min_inliers, double min_inlier_share)
      : min_inliers_{min_inliers}, min_inlier_share_{min_inlier_share} {}

  /// Most mapped beams are outliers: sensor or pose is wrong. (In a new place beams are unmapped.)
  bool is_refuted(const ScanMatch& match) const;

  /// Many more mapped beams are outliers than usual: pose or ranges may be wrong.
  bool is_contradicted(const ScanMatch& match) const;

  /// Nearly as many mapped beams are inliers as usual.
  bool is_as_usual_where_mapped(const ScanMatch& match) const;

  /// The share of all beams that are inliers is smaller than usual: the scan contradicts the map,
  /// or shows a new place. is_nearly_usual() may hold as well.
  bool is_worse_than_usual(const ScanMatch& match) const;

  /// Nearly as many of all beams are inliers as usual.
  bool is_nearly_usual(const ScanMatch& match) const;

  /// Updates the means with a scan that is not contradicted.
  void note_scan(const ScanMatch& match);

  /// Updates the means with the scan of a keyframe that was added to the graph.
  void note_keyframe(const ScanMatch& match);

 private:
  int min_inliers_;
  double min_inlier_share_;
  double inlier_share_{0.0};   ///< of the mapped beams, mean over scans
  double overall_share_{0.0};  ///< share of all beams that are inliers, mean over keyframes
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Matches that fit well or badly.
#pragma once

#include "slam/core/registration/usual_fit.hpp"

namespace waymark {

inline constexpr int kMinInliers = 15;

inline ScanMatch fit(double inlier_share, double mapped_share) {
  ScanMatch match;
  match.inlier_share = inlier_share;
  match.mapped_share = mapped_share;
  match.num_mapped = static_cast<int>(100.0 * mapped_share);
  match.inliers = static_cast<int>(inlier_share * match.num_mapped);
  return match;
}

inline UsualFit after_good_scans() {
  UsualFit usual{kMinInliers, 0.5};
  for (int i = 0; i < 100; ++i) {
    usual.note_scan(fit(0.95, 1.0));
    usual.note_keyframe(fit(0.95, 1.0));
  }
  return usual;
}

}  // namespace waymark

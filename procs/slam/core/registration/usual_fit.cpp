// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/usual_fit.hpp"

#include <algorithm>

namespace waymark {

bool UsualFit::is_refuted(const ScanMatch& match) const {
  return match.num_mapped >= min_mapped_ && match.inlier_share < min_inlier_share_;
}

bool UsualFit::is_contradicted(const ScanMatch& match) const {
  return match.num_mapped >= min_mapped_ &&
         match.inlier_share < std::max(min_inlier_share_, kContradicted * inlier_share_);
}

bool UsualFit::is_as_usual_where_mapped(const ScanMatch& match) const {
  return match.inlier_share >= kAsUsual * inlier_share_;
}

bool UsualFit::is_worse_than_usual(const ScanMatch& match) const {
  return match.inlier_share * match.mapped_share < kAsUsual * overall_share_;
}

bool UsualFit::is_nearly_usual(const ScanMatch& match) const {
  return match.inlier_share * match.mapped_share > kNearlyUsual * overall_share_;
}

void UsualFit::note_scan(const ScanMatch& match) {
  if (match.num_mapped < min_mapped_) return;
  inlier_share_ += kMemory * (match.inlier_share - inlier_share_);
}

void UsualFit::note_keyframe(const ScanMatch& match) {
  overall_share_ += kMemory * (match.inlier_share * match.mapped_share - overall_share_);
}

}  // namespace waymark

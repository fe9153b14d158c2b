// SPDX-License-Identifier: BSD-3-Clause
// Scan factors of the graph estimator.
#include "common/geometry/information.hpp"
#include "slam/core/estimators/waymark.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {

/// Divides the inliers of a match among the keyframes that observed their walls. Neighbouring
/// keyframes form a group, represented by one of them: where possible the same one for every scan,
/// so that the graph stays sparse.
std::vector<WaymarkEstimator::KeyframeGroup> WaymarkEstimator::keyframe_groups(
    const ScanMatch& match, bool is_loop) const {
  std::vector<KeyframeGroup> groups;
  const auto count = match.keyframe_shares.size();
  const auto first = static_cast<std::size_t>(match.first_keyframe);
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t group = (first + begin) / kGroupedKeyframes * kGroupedKeyframes;
    const std::size_t end = std::min(count, group + kGroupedKeyframes - first);
    double share = 0.0;
    double middle = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      share += match.keyframe_shares[i];
      middle += static_cast<double>(first + i) * match.keyframe_shares[i];
    }
    std::size_t reference =
        std::clamp(group + kGroupedKeyframes / 2, first + begin, first + end - 1);
    if (!is_loop) reference = std::max(reference, graph_.first_active_keyframe());
    begin = end;
    if (share <= 0.0 || reference >= first + end) continue;
    groups.push_back({reference, share, static_cast<std::size_t>(std::lround(middle / share))});
  }
  return groups;
}

/// The loaded map is fixed: a match with it is a prior on the pose.
/// @return whether a factor was added.
bool WaymarkEstimator::add_match_factor(std::size_t keyframe, const MatchedScan& scan) {
  const ScanMatch& match = scan.match;
  if (scan.submap != nullptr) return add_scan_factor(keyframe, *scan.submap, match, false);
  graph_.add(PosePrior{keyframe, match.map_from_base, root_of(match.observed.information)});
  return true;
}

/// @return whether there is a keyframe in the window that the scan can be related to.
bool WaymarkEstimator::add_scan_factor(std::size_t keyframe, const Submap& submap,
                                       const ScanMatch& match, bool is_loop) {
  ScanFactor factor;
  factor.is_loop = is_loop;
  factor.keyframe = keyframe;
  // If no scan constrains a group, its reference may have drifted relative to the keyframes that
  // observed the walls.
  Eigen::Matrix3d drift = Eigen::Matrix3d::Zero();
  for (const KeyframeGroup& group : keyframe_groups(match, is_loop)) {
    factor.references.push_back(
        {group.reference, group.share,
         submap.submap_from_keyframe(group.reference).inverse() * match.map_from_base});
    drift += group.share * group.share * unmatched_drift_.between(group.middle, group.reference);
  }
  if (!factor.normalise_shares()) return false;
  const Eigen::Matrix3d information =
      in_axes(match.map_from_base.rotation().transpose(), match.observed.information);
  const Eigen::Matrix3d drift_in_base =
      in_axes(graph_.state().keyframes[keyframe].rotation().transpose(), drift);
  factor.root_information = root_of(with_more_noise(information, drift_in_base));
  graph_.add(factor);
  return true;
}

}  // namespace waymark

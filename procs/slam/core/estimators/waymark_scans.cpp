// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses scans.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/registration/wide_search.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {

std::optional<WaymarkEstimator::MatchedScan> WaymarkEstimator::matched(
    const Points& points, const Prediction& prediction) const {
  if (points.empty()) return std::nullopt;
  MatchedScan scan;
  if (setup_.loaded_map) {
    scan.match =
        match_scan(points, setup_.loaded_map->walls, prediction.map_from_base,
                   prediction.covariance, range_noise_, config_.scan, loaded_coarse_.levels());
    if (is_frozen() || is_in_loaded_map(scan.match)) return scan;
  }
  scan.submap = submaps_.matched();
  if (scan.submap == nullptr) return std::nullopt;
  scan.map_from_submap = graph_.state().keyframes[scan.submap->first_keyframe()];
  const Se2 submap_from_map = scan.map_from_submap.inverse();
  const Se2 guess = submap_from_map * prediction.map_from_base;
  const Eigen::Matrix3d covariance = in_axes(submap_from_map.rotation(), prediction.covariance);
  scan.match = match_scan(points, scan.submap->surfaces(), guess, covariance, range_noise_,
                          config_.scan, scan.submap->coarse_surfaces());
  return scan;
}

/// Odometry may be off by more than plain matching can find: where a scan fits worse than the scans
/// before, places in wide windows are tried, too, also about where the robot would be without it:
/// that is wrong by a scan's motion at most. Needs a scan that was matched; once is enough.
void WaymarkEstimator::search_widely(Look& look) const {
  MatchedScan& scan = *look.scan;
  if (look.is_searched || !usual_fit_.is_worse_than_usual(scan.match)) return;
  look.is_searched = true;
  const Se2 submap_from_map = scan.map_from_submap.inverse();
  const Se2 submap_from_last =
      submap_from_map * (graph_.state().keyframes.back() * newest_from_last_scan_);
  const Se2 expected = submap_from_map * look.expected.map_from_base;
  WideSearch search;
  for (const Se2& step : odometry_check_.steps_without_odometry())
    search.without_odometry.push_back(submap_from_last * step);
  search.by_odometry = expected;
  search.odometry_covariance = in_axes(submap_from_map.rotation(), look.expected.covariance);
  search.since_last_s = look.since_last_s;
  search.min_score = config_.loops.min_score;
  scan.match = searched_widely(scan.match, look.points, surfaces_of(scan),
                               points_near(scan, expected, wide_search_reach_m(look.points)),
                               search, usual_fit_, range_noise_, config_.scan);
}

void WaymarkEstimator::add_scan_factor(std::size_t keyframe, const Submap& submap,
                                       const ScanMatch& match, bool is_loop) {
  ScanFactor factor;
  factor.is_loop = is_loop;
  factor.keyframe = keyframe;
  // Keyframes are put together, so that the whole graph stays sparse: the middle one of those that
  // saw the walls stands for its neighbours.
  const auto count = match.keyframe_shares.size();
  const auto first = static_cast<std::size_t>(match.first_keyframe);
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t group = (first + begin) / kGroupedKeyframes * kGroupedKeyframes;
    const std::size_t end = std::min(count, group + kGroupedKeyframes - first);
    double share = 0.0;
    double middle = 0.0;
    for (std::size_t i = begin; i < end; ++i) {
      share += match.keyframe_shares[i];
      middle += static_cast<double>(i) * match.keyframe_shares[i];
    }
    if (share > 0.0) middle /= share;
    std::size_t reference = first + static_cast<std::size_t>(std::lround(middle));
    if (!is_loop) reference = std::max(reference, graph_.first_active_keyframe());
    begin = end;
    if (share <= 0.0 || reference >= first + end) continue;
    factor.references.push_back(
        {reference, share, submap.submap_from_keyframe(reference).inverse() * match.map_from_base});
  }
  if (!factor.normalise_shares()) return;
  factor.root_information =
      root_of(in_axes(match.map_from_base.rotation().transpose(), match.observed.information));
  graph_.add(factor);
}

}  // namespace waymark

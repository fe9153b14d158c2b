// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses scans.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/registration/wide_search.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

/// Of a measurement whose covariance grows by `noise`; also where it says nothing along an axis.
Eigen::Matrix3d with_more_noise(const Eigen::Matrix3d& information, const Eigen::Matrix3d& noise) {
  if (noise.isZero(0.0)) return information;
  const Eigen::Matrix3d reduced =
      (Eigen::Matrix3d::Identity() + information * noise).inverse() * information;
  return 0.5 * (reduced + reduced.transpose());
}

}  // namespace

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
  scan.match = match_scan(points, scan.submap->ndt(), guess, covariance, range_noise_, config_.scan,
                          scan.submap->coarse_ndt());
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
  scan.match = searched_widely(scan.match, look.points, ndt_of(scan),
                               points_near(scan, expected, wide_search_reach_m(look.points)),
                               search, usual_fit_, range_noise_, config_.scan);
}

void WaymarkEstimator::add_scan_factor(std::size_t keyframe, const Submap& submap,
                                       const ScanMatch& match, bool is_loop) {
  ScanFactor factor;
  factor.is_loop = is_loop;
  factor.keyframe = keyframe;
  // Keyframes are put together: one stands for its neighbours. It is the same one for every scan,
  // so that the whole graph stays sparse. Where no scan has held the neighbours in place, it may be
  // off from those that saw the walls.
  Eigen::Matrix3d off = Eigen::Matrix3d::Zero();
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
    factor.references.push_back(
        {reference, share, submap.submap_from_keyframe(reference).inverse() * match.map_from_base});
    const auto seen_from = static_cast<std::size_t>(std::lround(middle / share));
    off += share * share * unmatched_drift_.between(seen_from, reference);
  }
  if (!factor.normalise_shares()) return;
  const Eigen::Matrix3d information =
      in_axes(match.map_from_base.rotation().transpose(), match.observed.information);
  const Eigen::Matrix3d off_in_base =
      in_axes(graph_.state().keyframes[keyframe].rotation().transpose(), off);
  factor.root_information = root_of(with_more_noise(information, off_in_base));
  graph_.add(factor);
}

}  // namespace waymark

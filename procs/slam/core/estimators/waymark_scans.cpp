// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses scans.
#include "common/geometry/information.hpp"
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/localisation/map_fit.hpp"
#include "slam/core/registration/wide_search.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {

WaymarkEstimator::SubmapPrediction WaymarkEstimator::in_submap(const Prediction& prediction,
                                                               const Se2& map_from_submap) {
  const Se2 submap_from_map = map_from_submap.inverse();
  return {submap_from_map * prediction.map_from_base,
          in_axes(submap_from_map.rotation(), prediction.covariance)};
}

std::optional<WaymarkEstimator::MatchedScan> WaymarkEstimator::matched(
    const Points& points, const Prediction& prediction) const {
  if (points.empty()) return std::nullopt;
  MatchedScan scan;
  if (loaded_map_) {
    scan.match = loaded_map_->match(points, prediction.map_from_base, prediction.covariance,
                                    range_noise_, config_.scan);
    if (is_map_fixed() || is_in_loaded_map(scan.match)) return scan;
  }
  scan.submap = submaps_.current();
  if (scan.submap == nullptr) return std::nullopt;
  scan.map_from_submap = graph_.state().keyframes[scan.submap->first_keyframe()];
  const SubmapPrediction guess = in_submap(prediction, scan.map_from_submap);
  const ScanMatch plain =
      match_scan(points, scan.submap->ndt(), guess.submap_from_base, guess.covariance, range_noise_,
                 config_.scan, scan.submap->coarse_ndt());
  scan.match = with_settled_walls(plain, points, scan.submap->ndt(), guess.covariance, range_noise_,
                                  config_.scan);
  return scan;
}

/// If a scan fits worse than usual, the predicted pose may be outside the matcher's basin of
/// convergence. Then wide windows are searched around that pose and around poses that do not use
/// odometry, which are wrong by the motion since the last scan at most. Needs a matched scan.
void WaymarkEstimator::search_widely(const Observation& observation, ScanAtPrediction& scan) const {
  MatchedScan& matched = *scan.matched;
  if (scan.was_searched_widely || !usual_fit_.is_worse_than_usual(matched.match)) return;
  scan.was_searched_widely = true;
  const Se2 submap_from_last = matched.map_from_submap.inverse() *
                               (graph_.state().keyframes.back() * newest_from_last_scan_);
  const SubmapPrediction expected = in_submap(scan.expected, matched.map_from_submap);
  WideSearch search;
  for (const Se2& step : odometry_check_.steps_without_odometry())
    search.without_odometry.push_back(submap_from_last * step);
  search.by_odometry = expected.submap_from_base;
  search.odometry_covariance = expected.covariance;
  search.since_last_s = scan.since_last_s;
  search.driven_m = (submap_from_last.translation() - search.by_odometry.translation()).norm();
  search.min_score = config_.loops.min_score;
  search.misfit = [&](const Se2& submap_from_base) {
    const Se2 map_from_base = matched.map_from_submap * submap_from_base;
    return fit_in_map(map_.map(), observation.beams, map_from_base).misfit();
  };
  matched.match = searched_widely(matched.match, scan.points, ndt_of(matched),
                                  points_near(matched, expected.submap_from_base,
                                              wide_search_reach_m(scan.points, search.driven_m)),
                                  search, usual_fit_, range_noise_, config_.scan);
}

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

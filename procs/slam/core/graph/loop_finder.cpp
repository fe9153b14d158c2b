// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/loop_finder.hpp"

#include "common/geometry/chi2.hpp"
#include "slam/core/registration/unique_place.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

namespace waymark {
namespace {

constexpr double kSigmas = 3.0;         // half side of a search window, in sigmas of the pose
constexpr double kDirectReach_m = 0.3;  // scan matching converges from this far away
constexpr double kDirectReach_rad = 0.15;
constexpr std::size_t kSearchBeams = 120;
constexpr std::size_t kFields = 8;                     // kept in the cache
const Eigen::Vector3d kMatchSigmas{0.05, 0.05, 0.01};  // of a match in a submap [m, m, rad]
/// Covariance of the best place of a correlative search: 0.1 m, 0.03 rad.
const Eigen::Matrix3d kSearchCovariance = Eigen::Vector3d{0.01, 0.01, 0.001}.asDiagonal();
constexpr double kAgree_m = 0.3;  // between two candidates' corrections
constexpr double kAgree_rad = 0.05;
constexpr double kAgreeWithin_m = 5.0;  // largest distance between the matches, driven and straight

double reach_m(const Eigen::Matrix3d& covariance) {
  return kSigmas * std::sqrt(std::max(covariance(0, 0), covariance(1, 1)));
}

double reach_rad(const Eigen::Matrix3d& covariance) {
  return kSigmas * std::sqrt(covariance(2, 2));
}

/// Covariance of the estimated pose relative to a match at a recent keyframe.
Eigen::Matrix3d since_match(std::size_t keyframe, const LoopSearch& search) {
  Eigen::Matrix3d covariance = kLoopCovarianceMargin * search.covariance_since(keyframe);
  covariance.diagonal() += kMatchSigmas.cwiseAbs2();
  return covariance;
}

}  // namespace

const Submap* LoopFinder::nearest_submap(const Guess& guess, const Scan& scan) const {
  const Submap* nearest = nullptr;
  double least_m = std::numeric_limits<double>::infinity();
  for (const Submap& submap : scan.submaps) {
    if (submap.last_keyframe() >= scan.search.first_recent_keyframe) break;
    const Eigen::Vector2d place =
        submap.submap_from_map(scan.state.keyframes) * guess.map_from_base.translation();
    const double off_m = reach_m(guess.covariance_against(submap.first_keyframe()));
    double near_m = std::min(least_m, config_.reach_m + std::min(config_.max_search_m, off_m));
    if (place.norm() - submap.radius_m() >= near_m) continue;
    for (std::size_t k = submap.first_keyframe(); k <= submap.last_keyframe(); ++k) {
      const double distance_m = (submap.submap_from_keyframe(k).translation() - place).norm();
      if (distance_m >= near_m) continue;
      least_m = near_m = distance_m;
      nearest = &submap;
    }
  }
  return nearest;
}

const CorrelativeField& LoopFinder::field_of(const Submap& old) {
  const auto known = std::find_if(fields_.begin(), fields_.end(), [&old](const auto& field) {
    return field.first == old.first_keyframe();
  });
  if (known != fields_.end()) {
    std::rotate(known, known + 1, fields_.end());
  } else {
    if (fields_.size() >= kFields) fields_.pop_front();
    fields_.emplace_back(old.first_keyframe(), CorrelativeField{old.points()});
  }
  return fields_.back().second;
}

std::optional<LoopMatch> LoopFinder::match(const Submap& old, const Guess& guess,
                                           const Scan& scan) {
  const Se2 submap_from_map = old.submap_from_map(scan.state.keyframes);
  const Se2 expected = submap_from_map * guess.map_from_base;
  const Eigen::Matrix3d covariance =
      in_axes(submap_from_map.rotation(), guess.covariance_against(old.first_keyframe()));
  // Scan matching first: the place nearest to the expected pose is the likeliest.
  LoopMatch loop{old.first_keyframe(), match_scan(scan.points, old.ndt(), expected, covariance,
                                                  scan.noise, scan_, old.coarse_ndt())};
  const double wide_m = std::min(config_.max_search_m, reach_m(covariance));
  const double wide_rad = std::min(std::numbers::pi, reach_rad(covariance));
  const bool is_near = wide_m < kDirectReach_m && wide_rad < kDirectReach_rad;
  if (is_near && !is_good(loop.match)) return std::nullopt;
  if (is_near && guess.is_estimate) return loop;
  const Points beams = thinned(scan.points, kSearchBeams);
  const CorrelativeField& field = field_of(old);
  if (!is_good(loop.match)) {
    const auto best = field.best(beams, expected, {wide_m, wide_rad}, config_.min_score);
    if (!best) return std::nullopt;
    loop.match = match_scan(scan.points, old.ndt(), best->submap_from_base, kSearchCovariance,
                            scan.noise, scan_);
    if (!is_good(loop.match)) return std::nullopt;
  }
  // The search for a runner-up is centred at the match, so that its window contains the match, and
  // reaches as far as the estimated pose.
  const Se2& found = loop.match.map_from_base;
  const Se2 estimated = submap_from_map * scan.search.map_from_base;
  const double moved_m = (found.translation() - estimated.translation()).norm();
  const double turned_rad = std::abs(angle_difference(found.theta(), estimated.theta()));
  const auto other = field.best_apart_from(found, kOtherPlace_m, kOtherPlace_rad, beams, found,
                                           {wide_m + moved_m, wide_rad + turned_rad},
                                           config_.runner_up_share * field.score(beams, found));
  if (other && is_other_place(*other, loop.match)) {
    ++num_ambiguous_;
    return std::nullopt;
  }
  return loop;
}

/// A runner-up that is shifted along the weak direction is no other place: along a bare corridor
/// the score is flat, and the match does not use that direction.
bool LoopFinder::is_other_place(const SearchMatch& other, const ScanMatch& match) {
  const Eigen::Vector2d apart =
      other.submap_from_base.translation() - match.map_from_base.translation();
  return apart.norm() < kOtherPlace_m || !match.observed.is_along_weak(apart);
}

bool LoopFinder::is_good(const ScanMatch& match) const {
  return match.is_usable(scan_) && match.inlier_share >= config_.min_inlier_share &&
         match.mapped_share >= config_.min_mapped_share;
}

/// Whether a match is good enough to override the covariance of the pose. A match with a single
/// wall is not: it leaves a direction unobserved, and walls look alike.
bool LoopFinder::is_convincing(const ScanMatch& match) const {
  return !match.observed.is_degenerate && match.inlier_share >= config_.surprise_share &&
         match.mapped_share >= config_.surprise_share;
}

/// Covariance of the estimated pose relative to a submap. After a recent loop with it or with a
/// neighbour, the error is bounded by that loop's error and the drift since then: consistent loops
/// support each other (Mangelson et al. 2018), and one that contradicts them exceeds the gate
/// sooner.
Eigen::Matrix3d LoopFinder::covariance_in(const Submap& old, const LoopSearch& search) const {
  const auto is_near = [&old](const Found& confirmed) {
    return confirmed.loop.submap + old.num_keyframes() >= old.first_keyframe() &&
           confirmed.loop.submap <= old.first_keyframe() + old.num_keyframes();
  };
  const auto last = std::find_if(confirmed_.rbegin(), confirmed_.rend(), is_near);
  const Eigen::Matrix3d covariance = search.covariance_against(old.first_keyframe());
  if (last == confirmed_.rend()) return covariance;
  // Holds whether or not the graph has already followed that loop.
  const Eigen::Matrix3d since =
      last->innovation * last->innovation.transpose() + since_match(last->keyframe, search);
  return smaller_covariance(since, covariance);
}

/// A degenerate match does not bound the drift along its weak direction.
void LoopFinder::note_confirmed(const Found& found) {
  if (!found.loop.match.observed.is_degenerate) confirmed_.push_back(found);
}

std::vector<LoopFinder::Found> LoopFinder::find(std::size_t keyframe, const Points& points,
                                                const LoopSearch& search,
                                                const std::deque<Submap>& submaps,
                                                const State& state, const RangeNoise& noise) {
  while (!confirmed_.empty() && confirmed_.front().keyframe < search.first_recent_keyframe)
    confirmed_.pop_front();
  candidate_age_m_ += search.driven_m;
  if (candidate_age_m_ > kAgreeWithin_m) candidate_.reset();
  const Scan scan{keyframe, points, search, submaps, state, noise};
  const auto place = place_near({search.map_from_base, search.covariance_against}, scan);
  if (place && place->is_expected) {
    candidate_.reset();
    note_confirmed(place->found);
    return {place->found};
  }
  if (candidate_) {
    const bool is_recent = candidate_->found.keyframe >= search.first_recent_keyframe;
    std::optional<Place> second = place;
    if ((!second || !agrees_with_candidate(*second, search)) && is_recent)
      second = place_near(corrected_by_candidate(search), scan);
    if (second && agrees_with_candidate(*second, search)) {
      const Found first = std::exchange(candidate_, std::nullopt)->found;
      note_confirmed(second->found);
      return {first, second->found};
    }
  }
  if (place) {
    candidate_ = {place->found, place->map_from_base * search.map_from_base.inverse(),
                  search.map_from_base};
    candidate_age_m_ = 0.0;
  }
  return {};
}

/// @return none if there is no good match, or if the match contradicts the estimated pose without
///         being convincing, or moves it along the match's unobserved direction.
std::optional<LoopFinder::Place> LoopFinder::place_near(const Guess& guess, const Scan& scan) {
  const Submap* old = nearest_submap(guess, scan);
  if (old == nullptr) return std::nullopt;
  const auto loop = match(*old, guess, scan);
  if (!loop) return std::nullopt;
  Place place;
  const Se2& map_from_submap = scan.state.keyframes[old->first_keyframe()];
  place.map_from_base = map_from_submap * loop->match.map_from_base;
  const Eigen::Vector3d off = pose_difference(place.map_from_base, scan.search.map_from_base);
  place.found = {scan.keyframe, *loop, off};
  const bool is_surprise =
      !guess.is_estimate || chi2(off, covariance_in(*old, scan.search)) > config_.gate;
  if (is_surprise && !is_convincing(loop->match)) return std::nullopt;
  const auto& observed = loop->match.observed;
  const Eigen::Vector2d weak = map_from_submap.rotation() * observed.weak_direction;
  // The search slides along a wall to where more of the scan is mapped.
  if (observed.is_degenerate && std::abs(weak.dot(off.head<2>())) > kDirectReach_m)
    return std::nullopt;
  const bool is_close =
      off.head<2>().norm() < kDirectReach_m && std::abs(off.z()) < kDirectReach_rad;
  place.is_expected = is_close && !is_surprise;
  return place;
}

/// The newest estimated pose, moved by the candidate's correction.
LoopFinder::Guess LoopFinder::corrected_by_candidate(const LoopSearch& search) const {
  const Eigen::Matrix3d since = since_match(candidate_->found.keyframe, search);
  return {candidate_->correction * search.map_from_base, [since](std::size_t) { return since; },
          false};
}

bool LoopFinder::agrees_with_candidate(const Place& place, const LoopSearch& search) const {
  // Both corrections are compared at the newest pose.
  const Eigen::Vector3d apart =
      pose_difference(candidate_->correction * search.map_from_base, place.map_from_base);
  return (candidate_->map_from_base.translation() - search.map_from_base.translation()).norm() <
             kAgreeWithin_m &&
         apart.head<2>().norm() < kAgree_m && std::abs(apart.z()) < kAgree_rad;
}

}  // namespace waymark

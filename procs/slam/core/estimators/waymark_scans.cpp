// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses scans.
#include "slam/core/estimators/waymark.hpp"
#include "slam/core/mapping/seen_through.hpp"

#include <Eigen/LU>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// Wide search for the pose of a scan that fits badly.
constexpr double kBadFit = 0.93;     // a scan below this share of the usual fit fits badly
constexpr double kFitMemory = 0.05;  // weight of the newest scan in what is usual
constexpr double kSearchReach_m = 0.5;
constexpr double kSearchReach_rad = 0.6;
constexpr std::size_t kSearchBeams = 120;
constexpr double kClearlyMore = 1.05;                  // inliers than the plain match has
const Eigen::Vector3d kFoundSigmas{0.05, 0.05, 0.03};  // of a search: a cell, a step of its turns

// Beams that end where the map is free.
constexpr double kMovingSigmas = 3.0;
constexpr double kMostOff_m = 0.3;  // of a beam's end; farther, walls stand in free places, too

}  // namespace

std::optional<WaymarkEstimator::MatchedScan> WaymarkEstimator::matched(
    const Points& points, const Prediction& prediction) const {
  if (points.empty()) return std::nullopt;
  MatchedScan scan;
  if (setup_.loaded_map) {
    scan.match = match_scan(points, setup_.loaded_map->walls, prediction.map_from_base,
                            prediction.covariance, range_noise_, config_.scan);
    if (is_frozen() || is_in_loaded_map(scan.match)) return scan;
  }
  if (growing_submaps_.empty()) return std::nullopt;
  scan.submap = &growing_submaps_.front();
  scan.map_from_submap = graph_.state().keyframes[scan.submap->first_keyframe()];
  const Se2 submap_from_map = scan.map_from_submap.inverse();
  const Se2 guess = submap_from_map * prediction.map_from_base;
  const Eigen::Matrix3d covariance = in_axes(submap_from_map.rotation(), prediction.covariance);
  scan.match =
      match_scan(points, scan.submap->surfaces(), guess, covariance, range_noise_, config_.scan);
  return scan;
}

/// Guesses of the pose without the prediction, map frame: the last pose, that pose after the last
/// step once more, and after a step of the odometry that was refused.
std::vector<Se2> WaymarkEstimator::without_odometry() const {
  const Se2 last = graph_.state().keyframes.back() * newest_from_last_scan_;
  std::vector<Se2> places{last, last * last_step_};
  if (odometry_refused_) places.push_back(last * refused_step_);  // a log may have a gap
  return places;
}

/// Odometry may be off by more than plain matching can find: where a scan fits worse than the scans
/// before, the best places in wide windows are tried, too, first where the robot would be without
/// odometry: that is wrong by a scan's motion at most. Needs a scan that was matched; once is
/// enough.
void WaymarkEstimator::search_widely(Look& look) const {
  MatchedScan& scan = *look.scan;
  if (look.is_searched || !is_bad_fit(scan.match)) return;
  look.is_searched = true;
  const Points& points = look.points;
  const Prediction& prediction = look.expected;
  const Se2 submap_from_map = scan.map_from_submap.inverse();
  double farthest_m = 0.0;
  for (const Eigen::Vector2d& point : points)
    farthest_m = std::max(farthest_m, point.norm());
  const CorrelativeField field{
      points_near(scan, submap_from_map * prediction.map_from_base, farthest_m + kSearchReach_m)};
  const Points beams = thinned(points, kSearchBeams);
  const Eigen::Matrix3d near = kFoundSigmas.cwiseAbs2().asDiagonal();
  std::vector<Se2> guesses = without_odometry();
  guesses.push_back(prediction.map_from_base);
  for (const Se2& guess : guesses) {
    const auto best = field.best(beams, submap_from_map * guess, {kSearchReach_m, kSearchReach_rad},
                                 config_.loops.min_score);
    if (!best) continue;
    const ScanMatch other = match_scan(points, surfaces_of(scan), best->submap_from_base, near,
                                       range_noise_, config_.scan);
    // A view of a new place has few inliers where it is right: it is left only if the map
    // contradicts it, or for a place where the scan fits as well as others do.
    if (other.inliers > kClearlyMore * scan.match.inliers &&
        (fits_badly(scan.match) || !is_bad_fit(other))) {
      scan.match = other;
    }
  }
}

/// Beams that end where the map is free, wherever about the prediction the robot is, show what
/// moves: people who walk along would hold the matches back. They are neither matched nor enter the
/// submaps. Where most of a scan is so, it is the pose that is wrong.
void WaymarkEstimator::leave_out_moving(const Prediction& where, Look& look) const {
  const double position_m2 = 0.5 * where.covariance.topLeftCorner<2, 2>().trace();
  Points standing;
  standing.reserve(look.points.size());
  for (const Eigen::Vector2d& point : look.points) {
    const double off_m =
        kMovingSigmas * std::sqrt(position_m2 + where.covariance(2, 2) * point.squaredNorm());
    if (off_m > kMostOff_m || !is_seen_through(map_.map(), where.map_from_base * point, off_m))
      standing.push_back(point);
  }
  if (2 * standing.size() < look.points.size()) return;
  look.beams_moving = look.points.size() - standing.size();
  look.points = std::move(standing);
}

void WaymarkEstimator::add_scan_factor(std::size_t keyframe, const Submap& submap,
                                       const ScanMatch& match, bool is_loop) {
  ScanFactor factor;
  factor.is_loop = is_loop;
  factor.keyframe = keyframe;
  // Keyframes are put together: one stands for its neighbours. It is the same one for every scan,
  // so that the whole graph stays sparse.
  const auto count = match.keyframe_shares.size();
  const auto first = static_cast<std::size_t>(match.first_keyframe);
  for (std::size_t begin = 0; begin < count;) {
    const std::size_t group = (first + begin) / kGroupedKeyframes * kGroupedKeyframes;
    const std::size_t end = std::min(count, group + kGroupedKeyframes - first);
    double share = 0.0;
    for (std::size_t i = begin; i < end; ++i)
      share += match.keyframe_shares[i];
    std::size_t reference =
        std::clamp(group + kGroupedKeyframes / 2, first + begin, first + end - 1);
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

/// Two submaps are filled at a time, one half a length behind the other: the older one is matched,
/// and holds half a length of scans at least.
void WaymarkEstimator::insert_scan(const Points& points) {
  const auto half = static_cast<std::size_t>(std::max(1, config_.submap_keyframes / 2));
  if (growing_submaps_.empty() || growing_submaps_.back().num_keyframes() >= half) {
    if (growing_submaps_.size() > 1) {
      submaps_.push_back(std::move(growing_submaps_.front()));
      submaps_.back().finish();
      growing_submaps_.pop_front();
    }
    growing_submaps_.emplace_back(config_.scan.cell_spacing_m, newest());
  }
  for (Submap& submap : growing_submaps_)
    submap.insert(points, submap_from_map(submap) * graph_.state().keyframes.back());
}

void WaymarkEstimator::learn_usual_fit(const ScanMatch& match) {
  usual_fit_ += kFitMemory * (match.inlier_share * match.mapped_share - usual_fit_);
}

bool WaymarkEstimator::is_bad_fit(const ScanMatch& match) const {
  return match.inlier_share * match.mapped_share < kBadFit * usual_fit_;
}

/// Most of what it shows stands where the map has something else, so that it is no view of a place
/// that is new: the sensor is wrong, or the pose.
bool WaymarkEstimator::is_refuted(const ScanMatch& match) const {
  return match.num_mapped >= config_.scan.min_inliers &&
         match.inlier_share < config_.min_inlier_share;
}

Se2 WaymarkEstimator::submap_from_map(const Submap& submap) const {
  return graph_.state().keyframes[submap.first_keyframe()].inverse();
}

}  // namespace waymark

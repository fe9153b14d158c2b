// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/localisation/place_finder.hpp"

#include "slam/core/localisation/map_fit.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

// All scores are natural logarithms of likelihood ratios, chosen so that a decision needs sightings
// of a marker in three frames, since a single frame may be wrong, or of two markers: two mistakes
// do not agree.
constexpr double kDecided = 2.5;  // lead over the second best hypothesis and the null hypothesis

// Hypotheses.
constexpr double kSame_m = 0.5;  // two hypotheses nearer than this are one
constexpr double kSame_rad = 0.3;
constexpr std::size_t kMaxHypotheses = 500;
constexpr double kHopeless = 12.0;  // score below the best one at which a hypothesis is dropped

// Markers.
constexpr double kSighting = 1.0;        // score of a marker that is sighted where the map has it,
constexpr double kAnother = 1.5;         // of the first sighting of a second one,
constexpr double kUnexpected = -1.0;     // of one that is mapped elsewhere, or in another's place,
constexpr double kMissed = -0.5;         // and of one that should be in view but is not sighted
constexpr double kMaxMarkerScore = 3.0;  // bound on the absolute score of one marker in one pass
constexpr double kFollowed = 0.5;        // gain with which a sighting corrects a hypothesis
constexpr double kAtMarker_m = 0.5;  // the nearest marker of its id within this is the one sighted
constexpr double kInItsPlace_m = 0.25;  // another marker within this of a sighting contradicts it
constexpr double kPassed_m = 1.0;       // driven without contribution until a marker's pass is over

// Walls.
constexpr double kWallsEvery_m = 0.1;
constexpr double kUsualMisfit = 0.15;  // share of beams that noise and changes make contradict
constexpr double kMisfit = 3.0;        // lost score per share of beams beyond kUsualMisfit
constexpr double kMinMapped = 0.3;     // share of beams on mapped walls at the right place
const Eigen::Vector3d kMatchSigmas{0.15, 0.15, 0.06};  // of a pose from one marker [m, m, rad]

// Markers in view.
constexpr double kMinFacing = 0.3;      // cosine between a marker's normal and the camera
constexpr double kWallInSight_m = 0.2;  // from a marker that is not occluded to a beam's end

}  // namespace

bool is_expected_in_view(const Se2& base_from_marker, const CameraView& view,
                         std::span<const AnnotatedBeam> beams) {
  const Eigen::Vector2d place = base_from_marker.translation();
  const Eigen::Vector2d to_camera = (view.base_from_camera.translation() - place).normalized();
  return base_from_marker.rotation().col(0).dot(to_camera) > kMinFacing && view.would_show(place) &&
         std::any_of(beams.begin(), beams.end(), [&](const AnnotatedBeam& annotated) {
           return (annotated.beam.end_in_base - place).norm() < kWallInSight_m;
         });
}

double PlaceFinder::Hypothesis::score() const {
  double sum = passed_score + wall_score;
  for (const auto& [clue, episode] : clues)
    sum += episode.score;
  return sum;
}

bool PlaceFinder::Hypothesis::is_second_marker(int index) const {
  bool has_other = false;
  for (const auto& [clue, episode] : clues) {
    if (clue.first != Clue::kLandmark) continue;
    if (clue.second == index) return false;
    has_other |= episode.score > 0.0;
  }
  return has_other;
}

void PlaceFinder::Hypothesis::add(Clue clue, int index, double score) {
  Episode& episode = clues[{clue, index}];
  episode.score = std::clamp(episode.score + score, -kMaxMarkerScore, kMaxMarkerScore);
  episode.idle_m = 0.0;
  if (clue == Clue::kLandmark && episode.score >= kMaxMarkerScore) seen_in_place.insert(index);
}

void PlaceFinder::Hypothesis::drive(double distance_m) {
  for (auto it = clues.begin(); it != clues.end();) {
    it->second.idle_m += distance_m;
    if (it->second.idle_m <= kPassed_m) {
      ++it;
      continue;
    }
    passed_score += it->second.score;
    it = clues.erase(it);
  }
}

PlaceFinder::PlaceFinder(std::shared_ptr<const MapSnapshot> map, const ScanMatchConfig& scan)
    : map_{map}, scan_{scan}, by_walls_{std::move(map), scan} {}

std::optional<Se2> PlaceFinder::update(const Motion& motion, const Observation& observation,
                                       std::span<const MarkerMeasurement> measurements,
                                       const CameraView& view, const RangeNoise& noise) {
  since_walls_m_ += motion.distance_m;
  by_walls_.follow(motion);
  for (Hypothesis& place : hypotheses_) {
    place.map_from_base = place.map_from_base * motion.start_from_end;
    place.drive(motion.distance_m);
  }
  propose(measurements);
  const bool scores_walls = !observation.beams.empty() && since_walls_m_ >= kWallsEvery_m;
  if (scores_walls) since_walls_m_ = 0.0;
  for (Hypothesis& place : hypotheses_) {
    score_markers(place, observation, measurements, view);
    if (scores_walls || (place.walls == Walls::kNotCompared && place.score() >= kDecided))
      score_walls(place, observation, noise);
  }
  std::erase_if(hypotheses_, [](const Hypothesis& place) { return place.score() < -kHopeless; });
  if (std::ranges::none_of(hypotheses_, &Hypothesis::may_be_right))
    return measurements.empty() ? by_walls_.search(observation, noise) : std::nullopt;
  std::stable_sort(hypotheses_.begin(), hypotheses_.end(),
                   [](const Hypothesis& a, const Hypothesis& b) { return a.score() > b.score(); });
  const Hypothesis& best = hypotheses_.front();
  const bool beats_others =
      hypotheses_.size() == 1 || best.score() - hypotheses_[1].score() >= kDecided;
  // Two markers at their mapped relative pose are no coincidence, even if others are missing.
  const bool beats_none = best.score() >= kDecided || best.seen_in_place.size() >= 2;
  if (beats_others && beats_none && best.walls != Walls::kContradict) return best.map_from_base;
  const double least = best.score() - kHopeless;
  std::erase_if(hypotheses_, [&](const Hypothesis& place) { return place.score() < least; });
  if (hypotheses_.size() > kMaxHypotheses) hypotheses_.resize(kMaxHypotheses);
  return std::nullopt;
}

void PlaceFinder::propose(std::span<const MarkerMeasurement> measurements) {
  for (const MarkerMeasurement& measurement : measurements) {
    for (const Landmark& landmark : map_->landmarks) {
      if (landmark.id != measurement.id || !landmark.is_confirmed()) continue;
      const Se2 there = landmark.map_from_marker * measurement.base_from_marker.inverse();
      const auto same =
          std::find_if(hypotheses_.begin(), hypotheses_.end(), [&](const Hypothesis& place) {
            const Eigen::Vector3d off = pose_difference(place.map_from_base, there);
            return off.head<2>().norm() < kSame_m && std::abs(off.z()) < kSame_rad;
          });
      if (same != hypotheses_.end()) continue;
      hypotheses_.emplace_back();
      hypotheses_.back().map_from_base = there;
    }
  }
}

std::optional<int> PlaceFinder::landmark_at(int id, const Eigen::Vector2d& place) const {
  std::optional<int> nearest;
  double least_m = kAtMarker_m;
  for (std::size_t i = 0; i < map_->landmarks.size(); ++i) {
    const Landmark& landmark = map_->landmarks[i];
    const double away_m = (landmark.map_from_marker.translation() - place).norm();
    if (landmark.id != id || !landmark.is_confirmed() || away_m >= least_m) continue;
    least_m = away_m;
    nearest = static_cast<int>(i);
  }
  return nearest;
}

void PlaceFinder::score_markers(Hypothesis& place, const Observation& observation,
                                std::span<const MarkerMeasurement> measurements,
                                const CameraView& view) const {
  const std::vector<int> seen = score_sightings(place, measurements);
  if (observation.camera_reported) score_misses(place, observation, seen, view);
}

/// @return the map's landmarks that were sighted, by index.
std::vector<int> PlaceFinder::score_sightings(
    Hypothesis& place, std::span<const MarkerMeasurement> measurements) const {
  std::vector<int> seen;
  for (const MarkerMeasurement& measurement : measurements) {
    const Eigen::Vector2d there =
        (place.map_from_base * measurement.base_from_marker).translation();
    if (const auto landmark = landmark_at(measurement.id, there)) {
      place.add(Clue::kLandmark, *landmark,
                place.is_second_marker(*landmark) ? kAnother : kSighting);
      const Eigen::Vector2d off =
          map_->landmarks[static_cast<std::size_t>(*landmark)].map_from_marker.translation() -
          there;
      place.map_from_base = {place.map_from_base.translation() + kFollowed * off,
                             place.map_from_base.theta()};
      seen.push_back(*landmark);
      continue;
    }
    const bool contradicts =
        std::any_of(map_->landmarks.begin(), map_->landmarks.end(), [&](const Landmark& landmark) {
          return landmark.id == measurement.id ||
                 (landmark.map_from_marker.translation() - there).norm() < kInItsPlace_m;
        });
    if (contradicts) place.add(Clue::kUnexpectedId, measurement.id, kUnexpected);
  }
  return seen;
}

void PlaceFinder::score_misses(Hypothesis& place, const Observation& observation,
                               std::span<const int> seen, const CameraView& view) const {
  const Se2 base_from_map = place.map_from_base.inverse();
  for (std::size_t i = 0; i < map_->landmarks.size(); ++i) {
    const Landmark& landmark = map_->landmarks[i];
    const int index = static_cast<int>(i);
    const bool is_near =
        (landmark.map_from_marker.translation() - place.map_from_base.translation()).norm() <
        view.range_max_m + kSame_m;
    const bool is_sighted =
        std::any_of(observation.sightings.begin(), observation.sightings.end(),
                    [&](const MarkerSighting& sighting) {
                      const Se2 there = place.map_from_base * sighting.base_from_marker;
                      return sighting.id == landmark.id &&
                             (there.translation() - landmark.map_from_marker.translation()).norm() <
                                 kAtMarker_m;
                    });
    if (is_near && !is_sighted && landmark.is_confirmed() &&
        std::find(seen.begin(), seen.end(), index) == seen.end() &&
        is_expected_in_view(base_from_map * landmark.map_from_marker, view, observation.beams)) {
      place.add(Clue::kLandmark, index, kMissed);
    }
  }
}

void PlaceFinder::score_walls(Hypothesis& place, const Observation& observation,
                              const RangeNoise& noise) const {
  const Points points = points_of(observation);
  const Eigen::Matrix3d near = kMatchSigmas.cwiseAbs2().asDiagonal();
  const ScanMatch match = match_scan(points, map_->walls, place.map_from_base, near, noise, scan_);
  if (match.is_usable(scan_)) place.map_from_base = match.map_from_base;
  const MapFit fit = fit_in_map(map_->grid, observation.beams, place.map_from_base);
  const bool fits = fit.fitting >= kMinMapped * fit.beams && !fit.is_contradicted();
  place.walls = fit.beams < MapFit::kMinBeams ? Walls::kTooFew
                : fits                        ? Walls::kFit
                                              : Walls::kContradict;
  if (fit.is_decisive()) place.wall_score -= kMisfit * std::max(0.0, fit.misfit() - kUsualMisfit);
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the graph estimator uses markers.
#include "slam/core/estimators/waymark.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kSamePlace_m = 0.5;    // between two markers at the same place
constexpr double kContradicts_m = 0.5;  // distance of a sighting from all mapped markers of its id
// While the pose is vague, a marker of its id nearer than kContradicts_m is the one that was
// sighted, and one nearer than this confirms the pose.
constexpr double kAgrees_m = 0.25;
// That distance while odometry stands still: the larger of kStandsStill_m and so many sigmas.
constexpr double kStandsStill_m = 0.03;
constexpr double kStandsStillSigmas = 4.0;
// A marker counts as missed if no frame of the last second has shown it.
constexpr Duration kSightingAge = std::chrono::seconds{1};

}  // namespace

/// A sighting far from all markers of its id needs a keyframe at once: the robot may have been
/// carried. While odometry stands still, a smaller distance is enough: odometry may be stuck.
bool WaymarkEstimator::is_contradicted_by(const Observation& observation) const {
  if (observation.sightings.empty() || keyframes_standing_ >= kMaxStanding) return false;
  const Se2 map_from_base = prediction().map_from_base;
  return std::any_of(
      observation.sightings.begin(), observation.sightings.end(), [&](const MarkerSighting& seen) {
        const Eigen::Vector2d place = map_from_base * seen.base_from_marker.translation();
        const double off_m =
            unmeasured_motion_.is_standing()
                ? std::max(kStandsStill_m, kStandsStillSigmas * seen.sigma_along_wall_m())
                : kContradicts_m;
        return book_.knows(seen.id) && !book_.has_one_near(graph_.state(), place, off_m, seen.id);
      });
}

/// Whether known markers are in view: these will observe the motion.
bool WaymarkEstimator::sees_known_markers(const Observation& observation) const {
  return std::any_of(observation.sightings.begin(), observation.sightings.end(),
                     [&](const MarkerSighting& seen) { return book_.knows(seen.id); });
}

std::vector<MarkerMeasurement> WaymarkEstimator::measured(const Observation& observation) const {
  return measure_markers(observation,
                         {std::sqrt(registration_.range_noise().variance_m2()),
                          setup_.camera.base_from_camera, setup_.sighting_noise},
                         graph_.odometry_noise(), config_.markers);
}

/// Whether the nearest marker of the sighted id is where it is mapped: within the gate or, beyond
/// it, near enough. Where odometry says little, a larger distance is more likely the robot's than
/// the marker's.
bool WaymarkEstimator::is_at_mapped_place(const MarkerInnovation& nearest,
                                          double within_if_vague_m) const {
  const bool is_pose_vague = verdict_ == RelocalisationMonitor::Verdict::kSlipped ||
                             unmeasured_motion_.is_standing() || unmeasured_motion_.is_unreliable();
  return nearest.chi2 < config_.marker_gate ||
         nearest.distance_m() < (is_pose_vague ? within_if_vague_m : config_.same_marker_within_m);
}

std::vector<PoseHint> WaymarkEstimator::hints(
    std::span<const MarkerMeasurement> measurements) const {
  std::vector<PoseHint> hints;
  for (const MarkerMeasurement& measurement : measurements) {
    PoseHint hint;
    hint.id = measurement.id;
    const Se2 there = map_from_measured(graph_.state(), newest(), measurement);
    const auto nearest = book_.nearest(graph_, newest(), measurement);
    const auto unique = book_.unique(measurement.id);
    if (unique) {
      const Se2 base_from_marker = graph_.state().keyframes.back().inverse() * there;
      hint.map_from_base = graph_.state().landmarks[*unique] * base_from_marker.inverse();
    }
    if (!nearest) {
      hint.kind = PoseHint::Kind::kNew;
      hint.is_in_known_place =
          book_.has_one_near(graph_.state(), there.translation(), kSamePlace_m);
    } else if (is_at_mapped_place(*nearest, kAgrees_m)) {
      hint.kind = PoseHint::Kind::kAgrees;
      hint.is_mapped_since = may_be_carried_since_ &&
                             book_.entries()[nearest->landmark].first_seen > *may_be_carried_since_;
    } else if (unique) {
      hint.kind = PoseHint::Kind::kElsewhere;
    } else {
      hint.kind = PoseHint::Kind::kAmbiguous;
    }
    hints.push_back(hint);
  }
  return hints;
}

void WaymarkEstimator::use_markers(std::span<const MarkerMeasurement> measurements) {
  struct Match {
    const MarkerMeasurement* measurement;
    std::optional<std::size_t> landmark{};  ///< none: a new one
  };

  std::vector<Match> matches;
  std::vector<std::size_t> returning;
  for (const MarkerMeasurement& measurement : measurements) {
    const auto nearest = book_.nearest(graph_, newest(), measurement);
    const bool is_it = nearest && is_at_mapped_place(*nearest, kContradicts_m);
    if (!is_it && (book_.is_full() || book_.is_misread(graph_.state(), newest(), measurement)))
      continue;
    if (measurement.wall) graph_.calibration_knowledge().observe(*measurement.wall);
    matches.push_back({&measurement});
    if (!is_it) continue;
    matches.back().landmark = nearest->landmark;
    book_.note_sighting(nearest->landmark, measurement.time);
    if (!markers_known_) learn_noise(*nearest, measurement);
    markers_known_ = true;
    // In a fixed map, this run's own markers are fixed, too, once they have left the window.
    if (loaded_map_ && nearest->landmark < loaded_map_->snapshot().landmarks.size())
      loaded_map_->trust(PlaceTrust::kKnown);
    if (!graph_.is_fixed(nearest->landmark) &&
        !graph_.is_active({VariableKind::kLandmark, nearest->landmark}))
      returning.push_back(nearest->landmark);
  }
  if (!matches.empty()) note_reason(EstimateReason::kMarker);
  if (markers_known_) unobserved_m_ = 0.0;
  // Before new landmarks are added, since step_whole_graph() also solves the window, and a landmark
  // without a measurement there would make the equations singular.
  if (!returning.empty()) step_whole_graph(returning);
  const std::size_t first_new = book_.entries().size();
  for (const Match& match : matches) {
    MarkerFactor factor;
    factor.keyframe = newest();
    factor.landmark =
        match.landmark ? *match.landmark : new_landmark(*match.measurement, first_new);
    factor.measurement = *match.measurement;
    factor.root_information = root_of(match.measurement->covariance.inverse());
    graph_.add(factor);
  }
  if (!matches.empty()) graph_.optimise();
  if (!returning.empty()) solve_schedule_.note_loop(true);
}

/// Landmark of a marker that was not in the map; further sightings of that marker in the same scan
/// get the same landmark.
/// @param first_new  index of the first landmark that this scan has added.
std::size_t WaymarkEstimator::new_landmark(const MarkerMeasurement& measurement,
                                           std::size_t first_new) {
  const Se2 there = map_from_measured(graph_.state(), newest(), measurement);
  for (std::size_t i = first_new; i < book_.entries().size(); ++i) {
    const double apart_m = (graph_.state().landmarks[i].translation() - there.translation()).norm();
    if (book_.entries()[i].id != measurement.id || apart_m >= config_.same_marker_within_m)
      continue;
    book_.note_sighting(i, measurement.time);
    return i;
  }
  book_.add(measurement.id, measurement.time);
  return graph_.add_landmark(there);
}

/// Negative information: a marker without a sighting is missed if the camera should have seen it
/// and nothing occludes it, since the LiDAR sees its wall.
std::vector<std::size_t> WaymarkEstimator::missed_markers(const Observation& observation,
                                                          const Se2& map_from_base) const {
  if (!observation.camera_reported) return {};
  const auto is_in_view = [&](const Se2& base_from_marker) {
    return is_expected_in_view(base_from_marker, setup_.camera, observation.beams);
  };
  return book_.missed(graph_.state(), map_from_base, is_in_view, observation.time - kSightingAge);
}

void WaymarkEstimator::note_misses(const Observation& observation) {
  book_.note_misses(missed_markers(observation, graph_.state().keyframes.back()));
}

}  // namespace waymark

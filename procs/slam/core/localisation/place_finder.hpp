// SPDX-License-Identifier: BSD-3-Clause
// Global localisation in a loaded map, by markers and walls.
#pragma once

#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/localisation/map_snapshot.hpp"
#include "slam/core/localisation/wall_place_finder.hpp"
#include "slam/core/registration/scan_match.hpp"
#include "slam/core/scan/observation.hpp"

#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <utility>
#include <vector>

namespace waymark {

/// Tracks a hypothesis for every pose at which a sighted marker would be one of the map's, until
/// one hypothesis wins.
///
/// Each hypothesis has a score, a log-likelihood ratio against the null hypothesis that the robot
/// is nowhere in the map. The contribution of one marker in one pass is bounded, since markers are
/// taken down and moved. The best hypothesis wins if the walls do not contradict it, is clearly
/// better than the second best, and is clearly better than the null hypothesis or has two markers
/// at their mapped places. So three sightings of one marker with a unique id are enough if nothing
/// contradicts them, or one of each of two markers; among several markers of one id, other markers
/// and walls decide. While the walls contradict every hypothesis and no marker is in view, walls
/// alone may decide (WallPlaceFinder).
class PlaceFinder {
 public:
  PlaceFinder(std::shared_ptr<const MapSnapshot> map, const ScanMatchConfig& scan);

  /// @param motion        since the last call.
  /// @param measurements  of the markers in the newest frame.
  /// @param view          of the camera: a marker that it should see but does not is a missed
  ///                      detection.
  /// @return map_from_base, once decided.
  std::optional<Se2> update(const Motion& motion, const Observation& observation,
                            std::span<const MarkerMeasurement> measurements, const CameraView& view,
                            const RangeNoise& noise);

 private:
  enum class Clue { kLandmark, kUnexpectedId };

  /// How the newest scan that was compared fits the map's walls.
  enum class Walls { kNotCompared, kTooFew, kFit, kContradict };

  struct Hypothesis {
    /// One pass by a marker.
    struct Episode {
      double score{0.0};
      double idle_m{0.0};  ///< driven since the last contribution
    };

    Se2 map_from_base{};
    double passed_score{0.0};  ///< sum over episodes that are over
    std::map<std::pair<Clue, int>, Episode> clues{};
    std::set<int> seen_in_place{};  ///< landmarks whose score has reached its upper bound
    double wall_score{0.0};
    Walls walls{Walls::kNotCompared};

    double score() const;

    bool may_be_right() const { return walls != Walls::kContradict; }

    /// Whether another landmark than this one has been sighted in its place in this pass, and this
    /// one has neither been sighted nor missed.
    bool is_second_marker(int index) const;

    void add(Clue clue, int index, double score);
    void drive(double distance_m);
  };

  void propose(std::span<const MarkerMeasurement> measurements);
  void score_markers(Hypothesis& place, const Observation& observation,
                     std::span<const MarkerMeasurement> measurements, const CameraView& view) const;
  std::vector<int> score_sightings(Hypothesis& place,
                                   std::span<const MarkerMeasurement> measurements) const;
  void score_misses(Hypothesis& place, const Observation& observation, std::span<const int> seen,
                    const CameraView& view) const;
  void score_walls(Hypothesis& place, const Observation& observation,
                   const RangeNoise& noise) const;
  std::optional<int> landmark_at(int id, const Eigen::Vector2d& place) const;

  std::shared_ptr<const MapSnapshot> map_;
  ScanMatchConfig scan_;
  std::vector<Hypothesis> hypotheses_{};
  double since_walls_m_{0.0};
  WallPlaceFinder by_walls_;
};

/// Whether the camera should see a marker: it faces the camera, is within its field of view and
/// range, and a beam ends beside it, so that nothing occludes it.
bool is_expected_in_view(const Se2& base_from_marker, const CameraView& view,
                         std::span<const AnnotatedBeam> beams);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Detects from markers that the estimated pose is wrong, and finds the correct one.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/motion.hpp"

#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>

namespace waymark {

/// One sighted marker compared with the map at the estimated pose.
struct PoseHint {
  enum class Kind {
    kAgrees,     ///< the marker is sighted where the map has it
    kNew,        ///< its id is not in the map
    kElsewhere,  ///< its id is mapped once, confirmed, but far from the sighting
    kAmbiguous,  ///< its id is mapped far away, but the marker may be another of that id
  };

  Kind kind{Kind::kNew};
  int id{-1};
  /// Pose of the robot if the marker has not moved. None if several markers carry the id.
  std::optional<Se2> map_from_base{};
  bool is_in_known_place{false};  ///< if kNew: the map has another marker at that place
};

/// Decides between two hypotheses. (1) The estimated pose is right: markers sighted away from their
/// mapped places were moved, are misread or have duplicates. (2) The robot was carried: the mapped
/// places of such markers give its pose.
///
/// Two markers, each sighted twice, that agree on a pose relocate the robot. A marker sighted where
/// it is mapped, or with an unknown id, supports (1). If two unknown ids then appear where the map
/// has other markers, the relocalisation is reverted: the place only looked alike.
///
/// If nobody can have carried the robot, since it drove all the time after a marker had confirmed
/// its pose, the two markers may as well have been moved together. Then the new pose is in doubt
/// until a third marker or the walls decide for it, or a marker or the walls for the pose before.
/// After that the two markers are taken for moved ones.
class RelocalisationMonitor {
 public:
  enum class Verdict { kConsistent, kSuspicious, kRelocated, kReverted };

  /// How the walls fit at a pose, compared with another pose.
  enum class Walls { kUndecided, kContradictFirst, kContradictSecond };
  using CompareWalls = std::function<Walls(const Se2& first, const Se2& second)>;

  /// @param motion          since the last call.
  /// @param may_be_carried  odometry stood still or jumped since the last call.
  /// @param compare_walls   of the newest scan; may be expensive.
  Verdict update(const Se2& map_from_base, std::span<const PoseHint> hints, const Motion& motion,
                 bool may_be_carried, const CompareWalls& compare_walls);

  /// After kRelocated and kReverted: the robot's new pose.
  const Se2& map_from_base() const { return relocated_; }

  /// While the pose is suspicious or in doubt: the other hypothesis.
  const std::optional<Se2>& alternative() const { return is_doubtful_ ? abandoned_ : alternative_; }

  /// Whether the robot was relocated, and it is not decided whether rightly.
  bool is_doubtful() const { return is_doubtful_; }

 private:
  void propagate(const Motion& motion);
  void drop_alternative();
  void support_alternative(const PoseHint& hint);
  int num_sightings() const;
  bool is_lookalike_place(std::span<const PoseHint> hints);
  Verdict relocate(const Se2& map_from_base, bool is_doubtful);
  Verdict revert();
  std::optional<Verdict> settle_doubt(const Se2& map_from_base, std::span<const PoseHint> hints,
                                      const CompareWalls& compare_walls);

  Se2 relocated_{};
  std::optional<Se2> alternative_{};
  std::map<int, int> sightings_{};  ///< number of sightings that support the alternative, by id
  double unsupported_m_{0.0};       ///< distance driven since the last such sighting

  std::optional<Se2> abandoned_{};  ///< pose before the relocalisation, propagated by odometry
  std::set<int> unexpected_ids_{};
  double relocated_m_{0.0};  ///< distance driven since the relocalisation

  /// A marker has confirmed the pose, and since then nobody can have carried the robot.
  bool is_certain_{false};
  bool is_doubtful_{false};
  std::set<int> relocated_by_{};        ///< ids that have relocated the robot
  std::map<int, int> votes_for_{};      ///< sightings in doubt, by id: for the new pose,
  std::map<int, int> votes_against_{};  ///< and for the abandoned one
  std::set<int> moved_ids_{};           ///< of markers that have relocated the robot wrongly
};

}  // namespace waymark

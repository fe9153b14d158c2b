// SPDX-License-Identifier: BSD-3-Clause
// Detects from markers that the estimated pose is wrong, and finds the correct one.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/motion.hpp"

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
  Se2 map_from_base{};            ///< if kElsewhere: pose of the robot if the marker has not moved
  bool is_in_known_place{false};  ///< if kNew: the map has another marker at that place
};

/// Decides between two hypotheses. (1) The estimated pose is right: markers sighted away from their
/// mapped places were moved, are misread or have duplicates. (2) The robot was carried: the mapped
/// places of such markers give its pose.
///
/// Two markers, each sighted twice, that agree on a pose relocate the robot. A marker sighted where
/// it is mapped, or with an unknown id, supports (1). If two unknown ids then appear where the map
/// has other markers, the relocalisation is reverted: the place only looked alike.
class RelocalisationMonitor {
 public:
  enum class Verdict { kConsistent, kSuspicious, kRelocated, kReverted };

  /// @param motion  since the last call.
  Verdict update(const Se2& map_from_base, std::span<const PoseHint> hints, const Motion& motion);

  /// After kRelocated and kReverted: the robot's new pose.
  const Se2& map_from_base() const { return relocated_; }

  /// While the pose is suspicious: the other hypothesis.
  const std::optional<Se2>& alternative() const { return alternative_; }

 private:
  void propagate(const Motion& motion);
  void drop_alternative();
  void support_alternative(const PoseHint& hint);
  int num_sightings() const;
  bool is_supported() const;
  bool is_lookalike_place(std::span<const PoseHint> hints);

  Se2 relocated_{};
  std::optional<Se2> alternative_{};
  std::map<int, int> sightings_{};  ///< number of sightings that support the alternative, by id
  double unsupported_m_{0.0};       ///< distance driven since the last such sighting

  std::optional<Se2> abandoned_{};  ///< pose before the relocalisation, propagated by odometry
  std::set<int> unexpected_ids_{};
  double relocated_m_{0.0};  ///< distance driven since the relocalisation
};

}  // namespace waymark

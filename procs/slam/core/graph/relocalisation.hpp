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
  Se2 map_from_base{};            ///< of kElsewhere: pose of the robot if the marker has not moved
  bool is_in_known_place{false};  ///< of kNew: the map has another marker at that place
};

/// Decides between two hypotheses. Either the estimated pose is right, and a marker that is sighted
/// elsewhere was moved, is misread or has a duplicate; or the robot was carried, and the mapped
/// places of such markers give its pose. The robot is relocated when two markers agree on the other
/// pose while no marker is sighted in its place and none is new. After a relocalisation to a place
/// that only looks alike, new ids appear where the map has other markers: two of them revert it.
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
  bool is_twin_place(std::span<const PoseHint> hints);

  Se2 relocated_{};
  std::optional<Se2> alternative_{};
  std::map<int, int> sightings_{};  ///< number of sightings that support the alternative, by id
  double unsupported_m_{0.0};       ///< driven since the last such sighting

  std::optional<Se2> abandoned_{};  ///< pose before the relocalisation, propagated by odometry
  std::set<int> unexpected_ids_{};
  double relocated_m_{0.0};  ///< driven since the relocalisation
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Detects from markers that the estimated pose is wrong, and finds the correct one.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/motion.hpp"

#include <cstddef>
#include <functional>
#include <map>
#include <optional>
#include <set>
#include <span>
#include <vector>

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
  /// If kAgrees: first sighted since the robot may have been carried, so that it confirms nothing.
  bool is_mapped_since{false};
};

/// Decides between three hypotheses about markers that are sighted away from their mapped places.
/// (1) The estimated pose is right: they were moved, are misread or have duplicates. (2) The wheels
/// slipped. (3) The robot was carried. In (2) and (3) their mapped places give its pose.
///
/// Two markers, each sighted twice, that agree on another pose decide: where nobody can have
/// carried the robot, one nearer than half a metre shows a slip; otherwise the robot is relocated.
/// A marker sighted where it is mapped, or with an unknown id, supports (1). If two unknown ids
/// then appear where the map has other markers, the relocalisation is reverted: the place only
/// looked alike.
///
/// If nobody can have carried the robot, since it drove all the time after a marker had confirmed
/// its pose, and wheels that spun do not explain the other pose, markers that are missed at the
/// estimated pose decide, or walls. With fewer than two missed markers there are more markers of
/// these ids, in a part of the building that is not mapped. With two, these may have been moved
/// together: the new pose is in doubt until a third is missed or the walls decide for it, or a
/// marker or the walls for the pose before. After that the two markers are taken for moved ones.
class RelocalisationMonitor {
 public:
  enum class Verdict {
    kConsistent,
    kSuspicious,
    kSlipped,  ///< the wheels have slipped: the markers have not moved
    kRelocated,
    kReverted,
  };

  /// How the walls fit at a pose, compared with another pose.
  enum class Walls { kUndecided, kContradictFirst, kContradictSecond };

  /// The newest frame and scan, compared with the map at a pose; may be expensive.
  struct View {
    std::function<Walls(const Se2& first, const Se2& second)> compare_walls{};
    /// Indices of the landmarks that should be in view and are not.
    std::function<std::vector<std::size_t>(const Se2& map_from_base)> missed{};
  };

  /// @param motion          since the last call.
  /// @param may_be_carried  by somebody, since is_certain() was last true.
  Verdict update(const Se2& map_from_base, std::span<const PoseHint> hints, const Motion& motion,
                 bool may_be_carried, const View& view);

  /// After kRelocated and kReverted: the robot's new pose.
  const Se2& map_from_base() const { return relocated_; }

  /// While the pose is suspicious or in doubt: the other hypothesis.
  std::optional<Se2> alternative() const {
    if (is_doubtful_) return abandoned_;
    return is_latent_ ? std::nullopt : alternative_;
  }

  /// Whether a marker has confirmed the pose, and since then nobody can have carried the robot.
  bool is_certain() const { return is_certain_; }

  /// Whether the robot was relocated, and it is not decided whether rightly.
  bool is_doubtful() const { return is_doubtful_; }

 private:
  void propagate(const Motion& motion);
  void drop_alternative();
  void support_alternative(const PoseHint& hint);
  int num_sightings() const;
  void note_unexpected(std::span<const PoseHint> hints);
  bool is_lookalike_place() const;
  Verdict relocate(const Se2& map_from_base, bool is_doubtful);
  Verdict revert();
  std::optional<Verdict> settle_doubt(const Se2& map_from_base, std::span<const PoseHint> hints,
                                      const View& view);
  void count_misses(const Se2& map_from_base, const View& view);
  std::ptrdiff_t num_missed() const;

  Se2 relocated_{};
  std::optional<Se2> alternative_{};
  std::map<int, int> sightings_{};  ///< number of sightings that support the alternative, by id
  double unsupported_m_{0.0};       ///< distance driven since the last such sighting
  bool is_latent_{false};           ///< too long since: it counts once another marker supports it

  std::optional<Se2> abandoned_{};  ///< pose before the relocalisation, propagated by odometry
  std::set<int> unexpected_ids_{};
  double relocated_m_{0.0};  ///< distance driven since the relocalisation

  bool is_certain_{false};
  bool is_doubtful_{false};
  std::set<int> relocated_by_{};         ///< ids that have relocated the robot
  std::map<int, int> votes_against_{};   ///< sightings in doubt that support the abandoned pose
  std::map<std::size_t, int> misses_{};  ///< by landmark, at the pose that markers have confirmed
  std::set<int> moved_ids_{};  ///< of markers taken for moved, or for others with the same id
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Notices that the robot is not where it is believed to be, and where it is instead.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/motion/motion.hpp"

#include <map>
#include <optional>
#include <set>
#include <span>

namespace waymark {

/// What one sighted marker says about the believed pose.
struct PoseHint {
  enum class Kind {
    kAgrees,     ///< it is where it is expected
    kNew,        ///< its id is not known
    kElsewhere,  ///< it is known, confirmed, the only one of its id, and not where it is seen
    kAmbiguous,  ///< it is not where it is expected, but might be another one of its id
  };

  Kind kind{Kind::kNew};
  int id{-1};
  Se2 map_from_base{};  ///< of kElsewhere: where the robot is if the marker is where it was
  bool is_in_known_place{false};  ///< of kNew: another marker is known to hang there
};

/// Weighs two hypotheses: the robot is where it is believed to be, and a marker that seems to be
/// elsewhere was moved, is misread or has a twin; or the robot was carried, and is where the known
/// places of those markers say. Two markers that agree about the other place, while none supports
/// the present one, decide. A robot that was relocated to the twin of a place meets new ids where
/// other markers should hang: two of them take it back.
class RelocalisationMonitor {
 public:
  enum class Verdict { kSettled, kDoubtful, kElsewhere, kBack };

  /// @param motion  since the last call.
  Verdict judge(const Se2& map_from_base, std::span<const PoseHint> hints, const Motion& motion);

  /// After kElsewhere and kBack: where the robot is.
  const Se2& map_from_base() const { return relocated_; }

  /// While there is a doubt: the other place.
  const std::optional<Se2>& alternative() const { return alternative_; }

 private:
  void follow(const Motion& motion);
  void forget_doubt();
  void support_alternative(const PoseHint& hint);
  int num_sightings() const;
  bool is_supported() const;
  bool is_twin_place(std::span<const PoseHint> hints);

  Se2 relocated_{};
  std::optional<Se2> alternative_{};
  std::map<int, int> sightings_{};  ///< by id, that support the alternative
  double unsupported_m_{0.0};       ///< driven since the last of them

  std::optional<Se2> given_up_{};  ///< the pose before the relocalisation, carried on by odometry
  std::set<int> unexpected_ids_{};
  double relocated_m_{0.0};  ///< driven since
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Messages -> scene. Inconsistent messages are counted and left out.
#pragma once

#include "common/messages/channels.hpp"
#include "common/node/node.hpp"
#include "common/time/clock_step_detector.hpp"
#include "viewer/core/scene/scene.hpp"

#include <cstdint>
#include <map>
#include <string_view>
#include <vector>

namespace waymark::viewer {

class SceneUpdater {
 public:
  /// Enough for 2 h at 30 Hz, 14 h at 5 Hz. A longer path is thinned to every second pose, so that
  /// memory is bounded.
  static constexpr std::size_t kMaxPathPoses = 250'000;

  SceneUpdater(Scene& scene, Counters& counters) : scene_{scene}, counters_{counters} {}

  /// Slam has begun another map: clears everything but odometry and true poses.
  void begin_map();
  void add(const map_tiles_t& message);
  /// Collects the parts of a marker map; replaces the landmarks once all parts of a stamp are in.
  void add(const marker_map_t& message);
  void add(const map_changes_t& message);
  void add(const findings_t& message);
  void add(const slam_estimate_t& message);
  void add(const annotated_scan_t& message);
  void add(const particles_t& message);
  /// Collects the parts of the final trajectory, which come in order; replaces it once all are in.
  void add(const trajectory_t& message);
  void add_odometry(const pose2D_t& message);
  void add_truth(const pose2D_t& message);

 private:
  /// Appends a pose of a live path; a pose with a wrong stamp is left out. When the clock is set
  /// back, the poses so far get earlier stamps, so that the path stays in order.
  template <class Pose>
  void append_live(std::vector<Pose>& path, ClockStepDetector& clock, const Pose& pose,
                   std::string_view path_name);
  /// Appends a pose if it is newer than all before.
  template <class Pose>
  void append(std::vector<Pose>& path, const Pose& pose, std::string_view path_name);

  Scene& scene_;
  Counters& counters_;
  ClockStepDetector estimate_clock_{};
  ClockStepDetector odometry_clock_{};
  ClockStepDetector truth_clock_{};
  std::int64_t marker_parts_utime_{-1};
  std::int32_t num_marker_parts_{0};
  std::map<std::int32_t, std::vector<Landmark>> marker_parts_{};
  std::int32_t num_trajectory_parts_{0};  ///< parts received so far
  std::vector<TimedPose> trajectory_parts_{};
};

}  // namespace waymark::viewer

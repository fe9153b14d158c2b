// SPDX-License-Identifier: BSD-3-Clause
// Messages -> views in the ViewStore, five a second.
#pragma once

#include "common/messages/channels.hpp"
#include "common/time/clock_step_detector.hpp"
#include "viewer/http/view_store.hpp"

#include <chrono>
#include <map>
#include <string>
#include <vector>

namespace waymark::viewer {

/// For the node's thread only. In a live run it posts five views per second of wall-clock time (one
/// per second while no client reads), and skips a view while a reader holds the lock. On a log it
/// posts five per second of message time.
class LiveFeed {
 public:
  enum class Pace { kWallClock, kMessageTime };

  LiveFeed(ViewStore& views, std::string title, Pace pace);

  /// Slam has begun another map: clears everything of the old one.
  void begin_map();
  void add(const map_tiles_t& message);
  void add(const annotated_scan_t& message);
  void add(const particles_t& message);
  void add(const image_t& message);
  void add(const marker_detections_t& message);
  void add(const process_status_t& message);
  void add(const slam_estimate_t& message, const EstimatedPose& estimate);

  /// An estimate without a pose: slam has not found the robot in its map.
  void add_unplaced(Timestamp time);

  /// @param landmarks  all markers in the map.
  void add_markers(Timestamp time, const std::vector<Landmark>& landmarks);

  /// @param findings  all findings so far.
  void add_findings(Timestamp time, const std::vector<Finding>& findings);

  /// In real time, also while no message comes.
  void note_silences(const Silences& silences);

  /// Posts the present view, also if it has to wait for readers.
  void post_last();

 private:
  /// Advances the current time to a message's stamp; ignores single wrong stamps, and follows a
  /// clock that was set.
  void advance_to(Timestamp time);
  /// Shifts the times that are compared with the current one when the clock is set.
  void follow_clock(Timestamp time);
  void post_when_due();
  ViewPtr snapshot();
  void grow_path(const Se2& map_from_base);

  ViewStore& views_;
  Pace pace_;
  LiveView current_{};
  LiveMap map_{};
  bool map_changed_{false};
  std::map<std::pair<int, int>, std::size_t> tile_index_{};  ///< into map_.tiles
  std::map<std::string, ProcessState> processes_{};
  std::vector<PathPoint> path_growth_{};  ///< points that are not posted yet
  PathPoint last_path_point_{};
  std::chrono::steady_clock::time_point last_post_wall_{};
  Timestamp last_post_{};
  ClockStepDetector clock_steps_{};
};

}  // namespace waymark::viewer

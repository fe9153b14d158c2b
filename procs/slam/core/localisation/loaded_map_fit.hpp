// SPDX-License-Identifier: BSD-3-Clause
// How what a run has seen fits the map that it has loaded.
#pragma once

#include <cstdint>

namespace waymark {

/// Keyframes' scans, and markers, that were compared with the loaded map.
struct LoadedMapFit {
  std::int64_t scans{0};             ///< with enough beams in mapped cells
  std::int64_t contradicting{0};     ///< of these, contradict the map
  std::int64_t refuting{0};          ///< of `scans`, with too many beams through its walls
  std::int64_t markers_in_place{0};  ///< markers of the map that were sighted where it has them
  std::int64_t markers_moved{0};     ///< those that hang elsewhere

  /// Fewer would be too few to tell another building from a few changes.
  static constexpr std::int64_t kMinScans = 40;
  static constexpr std::int64_t kMinMoved = 3;

  bool do_markers_contradict() const {
    return markers_moved >= kMinMoved && markers_moved > markers_in_place;
  }

  bool do_walls_contradict() const { return scans >= kMinScans && 2 * refuting > scans; }

  LoadedMapFit& operator+=(const LoadedMapFit& more) {
    scans += more.scans;
    contradicting += more.contradicting;
    refuting += more.refuting;
    markers_in_place += more.markers_in_place;
    markers_moved += more.markers_moved;
    return *this;
  }
};

}  // namespace waymark

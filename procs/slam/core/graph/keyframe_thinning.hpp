// SPDX-License-Identifier: BSD-3-Clause
// Selects redundant keyframes, so that the graph grows with the mapped area and not with time.
#pragma once

#include "slam/core/graph/graph.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace waymark {

/// Keeps the first keyframes of each place, and those that see a marker which few kept keyframes
/// see. The others are redundant. Of each run of consecutive redundant keyframes, the head and the
/// tail stay, too: each has enough constraints (ties), by markers and loops, to keyframes before
/// the run.
class KeyframeThinning {
 public:
  /// @param per_place  keyframes to keep per square metre and quarter of a turn.
  /// @param min_end    least number of keyframes in a head or tail, however many ties it has: newer
  ///                   scans and submaps refer to them.
  KeyframeThinning(int per_place, int min_end)
      : per_place_{static_cast<std::size_t>(per_place)},
        min_end_{static_cast<std::size_t>(min_end)} {}

  /// To be called after each keyframe; goes through the graph once per 100 keyframes.
  /// @return keyframes outside the window that may be removed. The anchor of each is the nearest
  ///         kept keyframe within the same square metre and quarter of a turn.
  std::vector<RemovedKeyframe> removable(const Graph& graph);

 private:
  using Place = std::array<int, 3>;  ///< column, row, direction

  struct Assessment {
    bool is_redundant{false};
    std::size_t anchor{0};   ///< of a redundant keyframe
    std::size_t tied_to{0};  ///< oldest keyframe that a full-rank constraint ties it to, or itself
  };

  /// Constraints of one keyframe to others.
  struct Ties {
    std::vector<std::size_t> landmarks{};  ///< measured from this keyframe
    std::size_t oldest{0};  ///< oldest keyframe in its loops; 0 with a pose prior; else itself
  };

  static Place place_of(const Se2& map_from_base);
  std::vector<Ties> ties_of_new(const Graph& graph) const;
  Assessment assess(std::size_t keyframe, const Ties& ties, const State& state);
  std::size_t end_of_head(std::size_t begin, std::size_t end) const;
  std::size_t begin_of_tail(std::size_t begin, std::size_t end, const Graph& graph) const;
  void add_removable(std::size_t begin, std::size_t end, const Graph& graph,
                     std::vector<RemovedKeyframe>& removable) const;

  std::size_t per_place_;
  std::size_t min_end_;
  std::vector<Assessment> assessments_{};  ///< of the keyframes outside the window
  std::size_t open_run_{0};                ///< first keyframe of a run that may still grow
  std::map<Place, std::vector<std::size_t>> kept_{};

  struct Sightings {
    std::size_t first_keyframe{0};
    std::size_t kept{0};  ///< number of kept keyframes that see the landmark
  };

  std::map<std::size_t, Sightings> sightings_{};  ///< by landmark
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Which keyframes a graph can do without, so that it grows with the area and not with time.
#pragma once

#include "slam/core/graph/graph.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace waymark {

/// The first keyframes of a place, and those that see a marker which few have seen, are needed.
/// Where the robot comes by again, a run of other keyframes is surplus, except for its two ends:
/// each is long enough to be tied to keyframes older than the run, by markers and loops.
class KeyframeThinning {
 public:
  /// @param per_place  keyframes that a square metre and a quarter of a turn need.
  /// @param least_end  keyframes of an end, however many ties it has: scans of the newest ones and
  ///                   submaps refer to those before them.
  KeyframeThinning(int per_place, int least_end)
      : per_place_{static_cast<std::size_t>(per_place)},
        least_end_{static_cast<std::size_t>(least_end)} {}

  /// To be asked after each keyframe. Looks only now and then.
  /// @return keyframes behind the window that may be removed, with the nearest needed one as their
  ///         carrier.
  std::vector<RemovedKeyframe> surplus(const Graph& graph);

 private:
  using Place = std::array<int, 3>;  ///< column, row, direction

  struct Judgement {
    bool is_needed{true};
    std::size_t carrier{0};  ///< of a keyframe that is not needed
    std::size_t tied_to{0};  ///< oldest keyframe that it is tied to in every direction, or itself
  };

  struct Ties {
    std::vector<std::size_t> landmarks{};
    std::size_t oldest{0};
  };

  static Place place_of(const Se2& map_from_base);
  std::vector<Ties> ties_of_new(const Graph& graph) const;
  Judgement judged(std::size_t keyframe, const Ties& ties, const State& state);
  std::size_t end_of_head(std::size_t begin, std::size_t end) const;
  std::size_t begin_of_tail(std::size_t begin, std::size_t end, const Graph& graph) const;
  void add_surplus(std::size_t begin, std::size_t end, const Graph& graph,
                   std::vector<RemovedKeyframe>& surplus) const;

  std::size_t per_place_;
  std::size_t least_end_;
  std::vector<Judgement> judgements_{};  ///< of the keyframes behind the window
  std::size_t open_run_{0};              ///< first keyframe of a run that may still grow
  std::map<Place, std::vector<std::size_t>> needed_{};

  struct Sightings {
    std::size_t first_keyframe{0};
    std::size_t needed{0};  ///< keyframes
  };

  std::map<std::size_t, Sightings> sightings_{};  ///< of landmarks
};

}  // namespace waymark

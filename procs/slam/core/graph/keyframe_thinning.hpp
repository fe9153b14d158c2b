// SPDX-License-Identifier: BSD-3-Clause
// Selects redundant keyframes, so that the graph grows with the mapped area and not with time.
#pragma once

#include "slam/core/graph/graph.hpp"

#include <array>
#include <cstddef>
#include <map>
#include <vector>

namespace waymark {

/// The first keyframes of each place are needed, and so are keyframes that see a marker seen by few
/// needed keyframes. Consecutive keyframes that are not needed form a run, which is redundant
/// except for its two ends. Each end is long enough to have constraints (ties) to keyframes older
/// than the run, by markers and loops.
class KeyframeThinning {
 public:
  /// @param per_place  needed keyframes per square metre and quarter of a turn.
  /// @param least_end  least number of keyframes in an end, however many ties it has: newer scans
  ///                   and submaps refer to them.
  KeyframeThinning(int per_place, int least_end)
      : per_place_{static_cast<std::size_t>(per_place)},
        least_end_{static_cast<std::size_t>(least_end)} {}

  /// To be called after each keyframe; goes through the graph once per 100 keyframes.
  /// @return keyframes behind the window that may be removed. The carrier of each is the nearest
  ///         needed keyframe.
  std::vector<RemovedKeyframe> surplus(const Graph& graph);

 private:
  using Place = std::array<int, 3>;  ///< column, row, direction

  struct Assessment {
    bool is_needed{true};
    std::size_t carrier{0};  ///< of a keyframe that is not needed
    std::size_t tied_to{0};  ///< oldest keyframe that a full-rank constraint ties it to, or itself
  };

  /// Constraints of one keyframe.
  struct Ties {
    std::vector<std::size_t> landmarks{};  ///< that it has measured
    std::size_t oldest{0};  ///< oldest one that its loops refer to, 0 with a prior, else itself
  };

  static Place place_of(const Se2& map_from_base);
  std::vector<Ties> ties_of_new(const Graph& graph) const;
  Assessment assess(std::size_t keyframe, const Ties& ties, const State& state);
  std::size_t end_of_head(std::size_t begin, std::size_t end) const;
  std::size_t begin_of_tail(std::size_t begin, std::size_t end, const Graph& graph) const;
  void add_surplus(std::size_t begin, std::size_t end, const Graph& graph,
                   std::vector<RemovedKeyframe>& surplus) const;

  std::size_t per_place_;
  std::size_t least_end_;
  std::vector<Assessment> assessments_{};  ///< of the keyframes behind the window
  std::size_t open_run_{0};                ///< first keyframe of a run that may still grow
  std::map<Place, std::vector<std::size_t>> needed_{};

  struct Sightings {
    std::size_t first_keyframe{0};
    std::size_t needed{0};  ///< number of needed keyframes
  };

  std::map<std::size_t, Sightings> sightings_{};  ///< of landmarks
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// The scans of a run, packed, to be drawn again.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/scan/observation.hpp"

#include <array>
#include <cstddef>
#include <deque>
#include <map>
#include <optional>
#include <vector>

namespace waymark {

/// 16 bytes a beam: single precision is 0.1 mm at 1 km. Where the robot comes by again and again,
/// the newest scans of each place and direction stay and the others are emptied, so that memory
/// grows with the area and not with time.
class ScanArchive {
 public:
  /// Scans that stay within a quarter of a metre and an eighth of a turn; one pass makes two or
  /// three, a turn on the spot nine.
  static constexpr std::size_t kScansPerPlace = 10;

  void add(const Observation& observation, const Se2& map_from_base);

  /// The scan that this one will empty.
  std::optional<std::size_t> emptied_by(const Observation& observation,
                                        const Se2& map_from_base) const;

  bool is_empty(std::size_t index) const {
    return scans_[index].beams.empty() && scans_[index].sightings.empty();
  }

  const std::vector<MarkerSighting>& sightings(std::size_t index) const {
    return scans_[index].sightings;
  }

  /// Also counts those that have been emptied.
  std::size_t size() const { return scans_.size(); }

  /// Where its beams went and which markers it showed; nothing else of it is kept.
  Observation at(std::size_t index) const;

 private:
  using Place = std::array<int, 4>;  ///< column, row, direction, whether it has beams

  struct PackedBeam {
    Eigen::Vector2f start_in_base;
    Eigen::Vector2f end_in_base;
  };

  struct Scan {
    std::vector<PackedBeam> beams{};
    std::vector<MarkerSighting> sightings{};
  };

  /// None of one that shows nothing.
  static std::optional<Place> place_of(const Observation& observation, const Se2& map_from_base);

  std::vector<Scan> scans_{};
  std::map<Place, std::deque<std::size_t>> at_places_{};  ///< indices, the oldest first
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// The scans of a run, packed, from which the map is redrawn.
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

/// 16 bytes per beam, in single precision. Only the newest scans of each place and direction are
/// kept and older ones are emptied, so that memory grows with the mapped area and not with time.
class ScanArchive {
 public:
  /// Scans that are kept per square of 0.25 m side and eighth of a turn. Driving through once makes
  /// two or three.
  static constexpr std::size_t kScansPerPlace = 10;

  void add(const Observation& observation, const Se2& map_from_base);

  /// The observation as at() will return it.
  static Observation as_kept(const Observation& observation) {
    return unpacked(packed(observation));
  }

  /// Index of the old scan that adding this one will empty.
  std::optional<std::size_t> emptied_by(const Observation& observation,
                                        const Se2& map_from_base) const;

  bool is_empty(std::size_t index) const {
    return scans_[index].beams.empty() && scans_[index].sightings.empty();
  }

  const std::vector<MarkerSighting>& sightings(std::size_t index) const {
    return scans_[index].sightings;
  }

  /// Number of scans, emptied ones included.
  std::size_t size() const { return scans_.size(); }

  /// Beams and sightings of a scan; the other members are not kept.
  Observation at(std::size_t index) const { return unpacked(scans_[index]); }

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

  static Scan packed(const Observation& observation);
  static Observation unpacked(const Scan& scan);

  /// None for an empty scan.
  static std::optional<Place> place_of(const Observation& observation, const Se2& map_from_base);

  std::vector<Scan> scans_{};
  std::map<Place, std::deque<std::size_t>> at_places_{};  ///< indices, the oldest first
};

}  // namespace waymark

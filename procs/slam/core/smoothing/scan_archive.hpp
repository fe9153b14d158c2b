// SPDX-License-Identifier: BSD-3-Clause
// The scans of a run, packed, to be drawn again.
#pragma once

#include "slam/core/scan/observation.hpp"

#include <cstddef>
#include <vector>

namespace waymark {

/// 16 bytes a beam: single precision is 0.1 mm at 1 km.
class ScanArchive {
 public:
  void add(const Observation& observation);

  std::size_t size() const { return scans_.size(); }

  /// Where its beams went and which markers it showed; nothing else of it is kept.
  Observation at(std::size_t index) const;

 private:
  struct PackedBeam {
    Eigen::Vector2f start_in_base;
    Eigen::Vector2f end_in_base;
  };

  struct Scan {
    std::vector<PackedBeam> beams{};
    std::vector<MarkerSighting> sightings{};
  };

  std::vector<Scan> scans_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// GMapping's matcher: score of a scan in a particle's map, and hill climbing to its maximum.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/gmapping/bell_curve.hpp"
#include "slam/core/gmapping/surroundings.hpp"
#include "slam/core/scan/beams.hpp"

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace waymark {

class Fields;

/// The condition that the cell before a hit is free ("free_cells" in this folder's README).
enum class FreeCells {
  kAsReleased,  ///< by a bug it reads a cell half a map away, never a wall: always fulfilled
  kIntended,    ///< the cell sqrt(2) cells before the end of the beam must not be a wall
};

/// GMapping's own names: core_fields.cpp. The sigmas are in m^2: the released code does not square.
struct MatcherConfig {
  double sigma_m2{0.05};
  double likelihood_sigma_m2{0.075};
  int kernel_size{1};
  double linear_step_m{0.05};
  double angular_step_rad{0.05};
  int iterations{5};
  int skip_beams{0};
  FreeCells free_cells{FreeCells::kAsReleased};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// The configuration that all matchers of a filter share, with its lookup table.
struct MatcherSetting {
  MatcherSetting(const MatcherConfig& matcher_config, const GridFrame& grid_frame);

  MatcherConfig config;
  GridFrame frame;
  BellCurve score_of;  ///< of a squared distance in cells^2
};

/// Compares one scan with one map. d of a beam is the distance from its end to the nearest mean of
/// hit points in the cells around it. One matcher per scan and map; the map must not change
/// meanwhile.
class ScanMatcher {
 public:
  ScanMatcher(const MatcherSetting& setting, const HitMap& map, std::span<const Beam> beams);

  /// Sum over the beams of exp(-d^2 / sigma); 0 for a beam without a hit nearby. From 0 to the
  /// number of beams.
  /// @param to_beat  once the score cannot exceed this, the remaining beams are not evaluated: the
  ///                 result is an upper bound of the score, not above `to_beat`.
  double score(const Se2& map_from_base, double to_beat = -1.0);

  /// Sum over the beams of -d^2 / lsigma; -0.5 / lsigma for a beam without a hit nearby.
  double log_likelihood(const Se2& map_from_base);

  struct Match {
    Se2 map_from_base{};
    double score{0.0};
  };

  /// Hill climbing from `start`: takes the best of six moves (along the map's x and y, and turns,
  /// in both directions) as long as one raises the score, and halves the step when none does.
  Match climb(const Se2& start);

 private:
  /// A beam in cells, base frame.
  struct Ray {
    double end_x;
    double end_y;
    double before_x;  ///< a point in the cell that has to be free
    double before_y;
  };

  /// Number of rays that are transformed together, with vector instructions.
  static constexpr std::size_t kAtOnce = 8;

  /// Squared distances of these rays [cells^2].
  struct Distances {
    std::array<float, kAtOnce> squared;
    std::size_t count;

    const float* begin() const { return squared.data(); }

    const float* end() const { return squared.data() + count; }
  };

  struct Transform;

  /// Distances from the ends of the rays from `first` on to the nearest hits.
  Distances nearest(std::size_t first, const Transform& map_from_ray);

  /// Sorts the rays so that those that fit worst at this pose come first: then a score that cannot
  /// win is abandoned sooner.
  void worst_first(const Se2& map_from_base);

  const MatcherSetting& setting_;
  Surroundings surroundings_;
  std::size_t num_rays_{0};
  std::vector<Ray> rays_{};  ///< padded to a multiple of kAtOnce
};

}  // namespace waymark

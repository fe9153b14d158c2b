// SPDX-License-Identifier: BSD-3-Clause
// GMapping's map and score, implemented in a slow and obvious way: the oracle for the fast ones.
#pragma once

#include "slam/core/gmapping/scan_matcher.hpp"

#include <cmath>
#include <map>
#include <optional>
#include <vector>

namespace waymark::testing {

/// All points that were hit, by cell.
class PlainHitMap {
 public:
  explicit PlainHitMap(const GridFrame& frame) : frame_{frame} {}

  void add(const Eigen::Vector2d& point_in_map) {
    points_[frame_.cell_of(point_in_map)].push_back(point_in_map);
  }

  const std::map<CellIndex, std::vector<Eigen::Vector2d>>& points() const { return points_; }

  Eigen::Vector2d mean_of(CellIndex cell) const {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (const Eigen::Vector2d& point : points_.at(cell))
      sum += point;
    return sum / static_cast<double>(points_.at(cell).size());
  }

  /// Distance from a beam's end to the nearest mean around it, section by section as described in
  /// slam/core/gmapping/README.md.
  std::optional<double> distance_m(const MatcherConfig& config, const Beam& beam,
                                   const Se2& map_from_base) const {
    const Eigen::Vector2d end = map_from_base * beam.end_in_base;
    const Eigen::Vector2d start = map_from_base * beam.start_in_base;
    const Eigen::Vector2d before =
        end - std::sqrt(2.0) * frame_.resolution_m * (end - start).normalized();
    const CellIndex end_cell = frame_.cell_of(end);
    const CellIndex before_cell = frame_.cell_of(before);
    std::optional<double> nearest_m;
    for (int y = -config.kernel_size; y <= config.kernel_size; ++y) {
      for (int x = -config.kernel_size; x <= config.kernel_size; ++x) {
        const CellIndex cell{end_cell.x + x, end_cell.y + y};
        const CellIndex free{before_cell.x + x, before_cell.y + y};
        if (!points_.contains(cell)) continue;
        if (config.free_cells == FreeCells::kIntended && points_.contains(free)) continue;
        const double distance_m = (end - mean_of(cell)).norm();
        if (!nearest_m || distance_m < *nearest_m) nearest_m = distance_m;
      }
    }
    return nearest_m;
  }

  double score(const MatcherConfig& config, const std::vector<Beam>& beams,
               const Se2& map_from_base) const {
    double score = 0.0;
    for (const Beam& beam : beams) {
      const auto d_m = distance_m(config, beam, map_from_base);
      if (d_m) score += std::exp(-*d_m * *d_m / config.sigma_m2);
    }
    return score;
  }

  double log_likelihood(const MatcherConfig& config, const std::vector<Beam>& beams,
                        const Se2& map_from_base) const {
    double sum = 0.0;
    for (const Beam& beam : beams) {
      const auto d_m = distance_m(config, beam, map_from_base);
      sum -= (d_m ? *d_m * *d_m : 0.5) / config.likelihood_sigma_m2;
    }
    return sum;
  }

 private:
  GridFrame frame_;
  std::map<CellIndex, std::vector<Eigen::Vector2d>> points_{};
};

}  // namespace waymark::testing

// SPDX-License-Identifier: BSD-3-Clause
// The cost of a scan in an NDT map.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/registration/ndt_map.hpp"

#include <Eigen/Core>

#include <span>
#include <unordered_map>
#include <vector>

namespace waymark {

struct ScanMatchConfig;

/// Factor on the information of each beam, given the number of the scan's beams that end in the
/// same cell: 1 for a few, less for many, since their errors are correlated.
double independent_share(int beams);

/// Number of keyframes from the first to the last that observed a cell; kNoKeyframe: 0.
int num_keyframes(const NdtCell& cell);

/// A quadratic model of the cost about a pose: cost + gradient' d + d' information d / 2.
struct Quadratic {
  Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
  Eigen::Vector3d gradient{Eigen::Vector3d::Zero()};
};

/// Residuals of one beam that ends in an NDT cell: across its wall, and along if it is no line.
struct BeamTerm {
  Eigen::Vector2d normal{Eigen::Vector2d::Zero()};
  double across_m{0.0};
  double along_m{0.0};
  double across_weight{0.0};  ///< inverse variances, times the robust weight
  double along_weight{0.0};
  double robust{0.0};  ///< Geman-McClure weight, 0..1
};

/// @param ray  from the base to the point, map's axes; approximates the beam, which begins at the
///             LiDAR.
BeamTerm compare(const NdtCell& cell, const Eigen::Vector2d& point, const Eigen::Vector2d& ray,
                 double point_variance_m2, double blur_m2, const ScanMatchConfig& config);

/// A scan in a map, with the cells of its points cached: most stay the same from step to step.
/// Keeps references to both.
class PointsInMap {
 public:
  /// @param uses_parts  of thick cells, if the map is divided.
  PointsInMap(std::span<const Eigen::Vector2d> points, const NdtMap& map, double point_variance_m2,
              bool uses_parts);

  /// @param min_keyframes  cells that fewer keyframes have observed are left out.
  Quadratic quadratic_about(const Se2& pose, double blur_m2, const ScanMatchConfig& config,
                            int min_keyframes = 0);

 private:
  struct Place {
    NdtMap::Key key{0};
    const NdtCell* cell{nullptr};
    int* beams{nullptr};  ///< number of the scan's beams in that cell, in all of its parts
    bool is_known{false};
  };

  void find_place(std::size_t point, const Eigen::Vector2d& there);

  std::span<const Eigen::Vector2d> points_;
  const NdtMap& map_;
  double point_variance_m2_;
  bool uses_parts_;
  std::vector<Place> places_;
  std::unordered_map<NdtMap::Key, int> beams_on_{};  ///< by cell; never iterated over
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// One map, drawn along one trajectory, for methods without a map per particle.
#pragma once

#include "slam/core/grid/grid_map.hpp"
#include "slam/core/mapping/landmark_map.hpp"
#include "slam/core/scan/observation.hpp"

namespace waymark {

class Fields;

struct MapperConfig {
  double resolution_m{0.05};
  double face_spacing_m{0.02};
  double face_margin_m{0.1};
  double same_marker_within_m{1.0};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

class Mapper {
 public:
  explicit Mapper(const MapperConfig& config);

  void insert(const Observation& observation, const Se2& map_from_base,
              const Eigen::Matrix3d& pose_covariance);

  const GridMap& map() const { return map_; }

  const LandmarkMap& landmarks() const { return landmarks_; }

 private:
  MapperConfig config_;
  GridMap map_;
  LandmarkMap landmarks_;
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/smoothing/retrospect.hpp"

namespace waymark {

GridMap Retrospect::redrawn_map(const MapperConfig& grid, const Statics& now,
                                double same_marker_within_m) const {
  const std::vector<Se2> way = hindsight_.way_of_updates(now, same_marker_within_m);
  Mapper mapper{grid};
  for (std::size_t i = 0; i < archive_.size(); ++i)
    mapper.insert(archive_.at(i), way[i], Eigen::Matrix3d::Zero());
  return mapper.map();
}

}  // namespace waymark

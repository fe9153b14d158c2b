// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/mapping/mapper.hpp"

#include "slam/core/mapping/insert_scan.hpp"

namespace waymark {

Mapper::Mapper(const MapperConfig& config)
    : config_{config},
      map_{GridFrame::centred_on_map_origin(config.resolution_m), {}, {}},
      landmarks_{config.same_marker_within_m} {}

void Mapper::insert(const Observation& observation, const Se2& map_from_base,
                    const Eigen::Matrix3d& pose_covariance) {
  insert_beams(observation.beams, map_from_base, map_);
  for (const MarkerSighting& sighting : observation.sightings) {
    const auto points = face_points(sighting, config_.face_spacing_m, config_.face_margin_m);
    insert_face_points(points, config_.face_spacing_m, map_from_base, map_);
    landmarks_.add(sighting, map_from_base, pose_covariance);
  }
}

}  // namespace waymark

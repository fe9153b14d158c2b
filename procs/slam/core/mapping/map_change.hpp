// SPDX-License-Identifier: BSD-3-Clause
// Differences between the world and a loaded map or a survey.
#pragma once

#include "common/geometry/se2.hpp"
#include "slam/core/scan/marker_sighting.hpp"

#include <Eigen/Core>

namespace waymark {

struct MapChange {
  /// Values as in lcmtypes/map_change_t.lcm.
  enum class Kind {
    kMarkerMoved = 1,
    kMarkerMissing,
    kMarkerNew,
    kWallNew,
    kWallGone,
    kSurveyOff,  ///< a surveyed marker is mapped away from its surveyed place
  };

  Kind kind{Kind::kMarkerNew};
  int id{kNoMarker};  ///< of the marker
  int instance{0};
  Se2 place{};                                      ///< map frame; of what is gone: the last place
  Eigen::Vector2d was_at{Eigen::Vector2d::Zero()};  ///< [m] in the loaded map, or the survey
  double size_m{0.0};                               ///< of a wall: longer side of its bounding box
  double sigmas{0.0};  ///< of kSurveyOff: distance in standard deviations
  int support{0};      ///< sightings, missed detections, or cells of a wall
};

}  // namespace waymark

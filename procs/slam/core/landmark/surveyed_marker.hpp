// SPDX-License-Identifier: BSD-3-Clause
// Surveyed pose of a marker.
#pragma once

#include "common/geometry/se2.hpp"

#include <Eigen/Core>

namespace waymark {

struct SurveyedMarker {
  int id{-1};
  Se2 survey_from_marker{};
  Eigen::Vector3d sigmas{Eigen::Vector3d::Ones()};  ///< x [m], y [m], yaw [rad]
  bool has_yaw{false};                              ///< else the yaw and its sigma are not used
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How a run uses a loaded map, and where in it the robot starts.
#pragma once

namespace waymark {

class Fields;

/// How a run uses a loaded map.
enum class MapMode {
  kMap,       ///< none is loaded: a new map is made
  kLocalise,  ///< the map does not change; memory is constant
  kExtend,    ///< the map's markers stay fixed, and new places are added in its frame
};

/// Where in a loaded map the robot starts.
enum class StartKind {
  kOrigin,    ///< at the map's origin: where mapping began or, with a survey, the survey's origin
  kPose,      ///< at a given pose
  kLast,      ///< where slam stopped, if map and odometry still match; else unknown
  kAnywhere,  ///< unknown
};

struct StartPose {
  StartKind kind{StartKind::kOrigin};
  double x_m{0.0};
  double y_m{0.0};
  double yaw_rad{0.0};
  double sigma_m{0.1};
  double sigma_rad{0.05};
  bool is_certain{false};  ///< no confirmation by markers or walls is needed

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

}  // namespace waymark

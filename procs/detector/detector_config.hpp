// SPDX-License-Identifier: BSD-3-Clause
// Configuration of waymark-detector: [robot] and [detector].
#pragma once

#include "common/config/config.hpp"
#include "common/robot/robot_config.hpp"
#include "detector/core/marker_detector.hpp"

#include <string>

namespace waymark {

/// Parameters of the stages of detection, and of the debug pictures.
struct DetectorSection : MarkerDetectorConfig {
  std::string debug_dir{};
  int debug_every{10};

  void describe(Fields& fields);
};

struct DetectorConfig {
  RobotConfig robot{};
  DetectorSection detector{};

  void describe(Fields& fields);
  void check(Problems& problems) const;
};

}  // namespace waymark

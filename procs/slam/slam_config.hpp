// SPDX-License-Identifier: BSD-3-Clause
// Configuration of the slam process: [robot] and [slam].
#pragma once

#include "common/bus/channel_names.hpp"
#include "common/config/config.hpp"
#include "common/robot/robot_config.hpp"
#include "slam/core/estimators/estimator.hpp"
#include "slam/core/estimators/gmapping.hpp"
#include "slam/core/estimators/marker_matching.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/input/sensor_queue.hpp"

#include <cstdint>
#include <filesystem>
#include <string>

namespace waymark {

enum class EstimatorName { kOdometry, kGmapping, kMarkerMatching, kWaymark };

struct SlamSection {
  EstimatorName estimator{EstimatorName::kWaymark};
  std::int64_t seed{1};
  int threads{1};
  bool blank_ids{false};
  double map_period_s{1.0};
  MapMode mode{MapMode::kMap};
  StartPose start{};
  double save_map_every_s{0.0};  ///< 0: only at the end
  std::string state_folder{};    ///< empty: none
  bool commands{false};
  Preprocessing preprocessing{};
  MotionNoise motion{};
  UpdateGate gate{};
  MapperConfig grid{};
  GmappingConfig gmapping{};
  MarkerMatchingConfig marker_matching{};
  WaymarkConfig waymark{};

  void describe(Fields& fields);
};

struct SlamConfig {
  RobotConfig robot{};
  SlamSection slam{};
  ChannelNames channels{};           ///< [channels], as in every program
  std::filesystem::path load_map{};  ///< from the command line; empty: none
  std::filesystem::path save_map{};
  bool keeps_old_map{false};  ///< save_map holds another map, which is to be renamed: load_map()

  void describe(Fields& fields);
  void check(Problems& problems) const;
};

SensorSetup sensor_setup(const SlamConfig& config);
EstimatorSetup estimator_setup(const SlamConfig& config);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the core's parameters stand in a configuration. The core itself knows no files.
#include "common/config/fields.hpp"
#include "slam/core/estimators/marker_matching.hpp"

namespace waymark {

void MotionNoise::describe(Fields& fields) {
  fields.field("along_per_sqrt_m", along_per_sqrt_m, kNotNegative,
               "noise along the motion [m/sqrt(m)]");
  fields.field("turn_per_sqrt_m", turn_per_sqrt_m, kNotNegative,
               "noise of the heading by distance [rad/sqrt(m)]");
  fields.field("turn_per_sqrt_rad", turn_per_sqrt_rad, kNotNegative,
               "noise of the heading by turn [rad/sqrt(rad)]");
  fields.field("rotation_only", rotation_only,
               "the paper to the letter: no noise along the motion");
}

void UpdateGate::describe(Fields& fields) {
  fields.field("distance_m", distance_m, kNotNegative, "a scan is used after this much driving");
  fields.field("turn_rad", turn_rad, kNotNegative, "or this much turning");
}

void MapperConfig::describe(Fields& fields) {
  fields.field("resolution_m", resolution_m, {0.005, 1.0}, "side of a cell");
  fields.field("face_spacing_m", face_spacing_m, {0.001, 1.0},
               "between the points that stand for a marker's face");
  fields.field("face_margin_m", face_margin_m, {0.0, 1.0},
               "bare wall beside a marker that is seen together with it");
  fields.field("same_marker_within_m", same_marker_within_m, kPositive,
               "sightings of an id nearer than this are of one marker");
}

void MatchingRewards::describe(Fields& fields) {
  fields.field("strong_reward", strong_reward, kNotNegative,
               "log weight of a beam whose id matches its cell's");
  fields.field("penalty", penalty, kNotNegative, "log weight lost where they differ");
  fields.field("weak_reward", weak_reward, kNotNegative,
               "log weight of a beam without marker that ends on a mapped wall");
}

void MarkerMatchingConfig::describe(Fields& fields) {
  fields.field("particles", particles, {1, 100000}, "number of hypotheses");
  fields.field("resample_threshold", resample_threshold, kFraction,
               "share of effective particles below which to resample");
  fields.field("sighting_sigma_m", sighting_sigma_m, kPositive,
               "a sighting with this error along its wall counts half");
  fields.field("lost_agreement", lost_agreement, kFraction,
               "share of the beams that must end on mapped walls, else the robot is lost");
  fields.section("rewards", rewards);
}

}  // namespace waymark

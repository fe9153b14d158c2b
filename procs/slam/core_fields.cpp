// SPDX-License-Identifier: BSD-3-Clause
// Keys, ranges and explanations of the core's parameters; the core itself does not depend on files.
#include "common/config/fields.hpp"
#include "slam/core/estimators/gmapping.hpp"
#include "slam/core/estimators/marker_matching.hpp"
#include "slam/core/estimators/waymark_config.hpp"
#include "slam/core/input/preprocessing.hpp"
#include "slam/sigma_range.hpp"

namespace waymark {

void MotionNoise::describe(Fields& fields) {
  fields.field("along_per_sqrt_m", along_per_sqrt_m, kNotNegative,
               "noise along the motion [m/sqrt(m)]");
  fields.field("turn_per_sqrt_m", turn_per_sqrt_m, kNotNegative,
               "noise of the heading by distance [rad/sqrt(m)]");
  fields.field("turn_per_sqrt_rad", turn_per_sqrt_rad, kNotNegative,
               "noise of the heading by turn [rad/sqrt(rad)]");
  fields.field("rotation_only", rotation_only, "the paper's model: no noise along the motion");
}

void StartPose::describe(Fields& fields) {
  fields.field("x_m", x_m, kAnyNumber, "x of the robot in the map");
  fields.field("y_m", y_m, kAnyNumber, "y of the robot in the map");
  fields.field("yaw_rad", yaw_rad, kAnyNumber, "heading of the robot in the map");
  fields.field("sigma_m", sigma_m, kSigmaRange, "standard deviation of x and of y");
  fields.field("sigma_rad", sigma_rad, kSigmaRange, "standard deviation of the heading");
}

void UpdateGate::describe(Fields& fields) {
  fields.field("distance_m", distance_m, kNotNegative, "a scan is used after this much driving");
  fields.field("turn_rad", turn_rad, kNotNegative, "or this much turning");
}

void MapperConfig::describe(Fields& fields) {
  fields.field("resolution_m", resolution_m, {0.005, 1.0}, "side of a cell");
  fields.field("face_spacing_m", face_spacing_m, {0.001, 1.0},
               "distance between the points that represent a marker's face");
  fields.field("face_margin_m", face_margin_m, {0.0, 1.0},
               "bare wall beside a marker that is seen together with it");
  fields.field("same_marker_within_m", same_marker_within_m, kPositive,
               "sightings of one id nearer than this are of the same marker");
}

void Preprocessing::describe(Fields& fields) {
  fields.field("beam_tolerance_m", beam_tolerance_m, kPositive,
               "a beam that ends this near to a sighted marker gets its id");
  fields.field("view_margin_rad", view_margin_rad, kNotNegative,
               "a marker nearer than this to the image's edge may be missed");
  fields.field(
      "detectable_px", detectable_px, kPositive,
      "a marker whose side is shorter in the image may be missed: no evidence of its absence");
  fields.field("max_sigma_m", max_sigma_m, kPositive,
               "sightings with a larger standard deviation along their wall are not used");
  fields.field("marker_wait_s", marker_wait_s, {0.0, 10.0},
               "how long a scan waits for the camera frames up to its time");
  fields.field("scan_wait_s", scan_wait_s, {0.0, 10.0},
               "how late a scan may be before odometry and camera continue without it");
}

void StepNoise::describe(Fields& fields) {
  fields.field("srr", srr, kNotNegative, "srr: translation by translation [m/m]");
  fields.field("srt", srt, kNotNegative, "srt: rotation by translation [rad/m]");
  fields.field("str", str, kNotNegative, "str: translation by rotation [m/rad]");
  fields.field("stt", stt, kNotNegative, "stt: rotation by rotation [rad/rad]");
}

void ScanGate::describe(Fields& fields) {
  fields.field("linear_update_m", linear_update_m, kNotNegative,
               "linearUpdate: a scan is processed after this much driving");
  fields.field("angular_update_rad", angular_update_rad, kNotNegative,
               "angularUpdate: or this much turning");
  fields.field("temporal_update_s", temporal_update_s, kAnyNumber,
               "temporalUpdate: or more than this much time; negative: never");
}

void MatcherConfig::describe(Fields& fields) {
  fields.field("sigma_m2", sigma_m2, kPositive, "sigma: a beam scores exp(-d^2 / sigma)");
  fields.field("likelihood_sigma_m2", likelihood_sigma_m2, kPositive,
               "lsigma: log-likelihood of a beam is -d^2 / lsigma");
  fields.field("kernel_size", kernel_size, {0.0, 10.0},
               "kernelSize: cells searched around the end of a beam, each way");
  fields.field("linear_step_m", linear_step_m, kPositive, "lstep: first step of the climb");
  fields.field("angular_step_rad", angular_step_rad, kPositive, "astep: first turn of the climb");
  fields.field("iterations", iterations, {0.0, 30.0}, "iterations: how often the steps are halved");
  fields.field("skip_beams", skip_beams, {0.0, 1000.0},
               "lskip: beams left out between two that are matched");
  fields.choice("free_cells", free_cells,
                {{"as_released", FreeCells::kAsReleased}, {"intended", FreeCells::kIntended}},
                "whether a wall just before the end of a beam rejects the hit, or, as in the "
                "released code, never does");
}

void GmappingConfig::describe(Fields& fields) {
  fields.field("particles", particles, {1.0, 10000.0}, "particles: number of hypotheses");
  fields.field("max_range_m", max_range_m, kNotNegative,
               "maxRange: longer beams are dropped; 0 = a centimetre less than the LiDAR's");
  fields.field("max_usable_range_m", max_usable_range_m, kNotNegative,
               "maxUrange: longer beams are not matched, and clear the map up to here; 0 = "
               "max_range_m");
  fields.field("minimum_score", minimum_score, kNotNegative,
               "minimumScore: a match must score more, else the pose from odometry is kept");
  fields.field("resample_threshold", resample_threshold, kFraction,
               "resampleThreshold: share of effective particles below which to resample");
  fields.field("likelihood_gain", likelihood_gain, kPositive,
               "ogain: log weights are divided by this times the number of particles");
  fields.field("occupied_threshold", occupied_threshold, kFraction,
               "occ_thresh: share of hits above which a cell is published as occupied");
  fields.field("watch_turns", watch_turns,
               "if scans contradict odometry's turn, use theirs; the released code: false");
  fields.section("motion", motion);
  fields.section("gate", gate);
  fields.section("matcher", matcher);
}

void MatchingRewards::describe(Fields& fields) {
  fields.field("strong_reward", strong_reward, kNotNegative,
               "log weight of a beam whose id matches its cell's");
  fields.field("penalty", penalty, kNotNegative, "log weight lost where they differ");
  fields.field("weak_reward", weak_reward, kNotNegative,
               "log weight of a beam without a marker that ends on a mapped wall");
}

void MarkerMatchingConfig::describe(Fields& fields) {
  fields.field("particles", particles, {1, 100000}, "number of hypotheses");
  fields.field("resample_threshold", resample_threshold, kFraction,
               "share of effective particles below which to resample");
  fields.field("sighting_sigma_m", sighting_sigma_m, kPositive,
               "a sighting with this standard deviation along its wall has half the weight");
  fields.field("lost_agreement", lost_agreement, kFraction,
               "share of the beams that must end on mapped walls, else the robot is lost");
  fields.section("rewards", rewards);
}

void OdometryNoise::describe(Fields& fields) {
  fields.field("along_per_sqrt_m", along_per_sqrt_m, kNotNegative,
               "random walk of the distance [m/sqrt(m)]");
  fields.field("across_per_sqrt_m", across_per_sqrt_m, kNotNegative,
               "random walk sideways, beyond what the heading explains [m/sqrt(m)]");
  fields.field("turn_per_sqrt_m", turn_per_sqrt_m, kNotNegative,
               "random walk of the heading by distance [rad/sqrt(m)]");
  fields.field("turn_per_sqrt_rad", turn_per_sqrt_rad, kNotNegative,
               "random walk of the heading by turn [rad/sqrt(rad)]");
  fields.field("scale_sigma", scale_sigma, kPositive,
               "standard deviation of the scale of distances");
  fields.field("turn_scale_sigma", turn_scale_sigma, kPositive,
               "standard deviation of the scale of turns");
  fields.field("drift_sigma_rad_per_m", drift_sigma_rad_per_m, kPositive,
               "standard deviation of the heading's systematic drift");
  fields.field("lidar_ahead_sigma_m", lidar_ahead_sigma_m, kPositive,
               "standard deviation of the LiDAR's x from its configured place");
  fields.field("lidar_yaw_sigma_rad", lidar_yaw_sigma_rad, kPositive,
               "standard deviation of the LiDAR's yaw from its configured one");
  fields.field("may_slip", may_slip,
               "whether wheel slip, pushes and jumps are modelled besides the random walk");
}

void MarkerMeasurementConfig::describe(Fields& fields) {
  fields.field("reach_m", reach_m, kPositive,
               "length of wall on each side of a marker that is assumed to be straight");
  fields.field("covariance_factor", covariance_factor, kPositive,
               "factor on the detector's covariances: errors of successive frames are correlated");
  fields.field(
      "gate", gate, kPositive,
      "chi^2 (2 degrees of freedom; 13.8 = 99.9 %) between camera and wall beyond which a sighting "
      "is rejected");
}

void ScanMatchConfig::describe(Fields& fields) {
  fields.field("cell_spacing_m", cell_spacing_m, kPositive,
               "distance between centres of NDT cells");
  fields.field("kernel_sigmas", kernel_sigmas, kPositive,
               "robust kernel: a beam this far from its wall has a quarter of the weight");
  fields.field("roughness_m", roughness_m, kNotNegative,
               "of walls, in addition to the range noise");
  fields.field(
      "weak_share", weak_share, kFraction,
      "share of the strongest direction's information below which a direction is unobserved");
  fields.field("min_inliers", min_inliers, {1, 100000},
               "a scan with fewer inlier beams is not used");
}

void LoopConfig::describe(Fields& fields) {
  fields.field("enabled", enabled, "whether loops are closed");
  fields.field("every_m", every_m, kPositive, "distance driven between two searches");
  fields.field("reach_m", reach_m, kPositive, "how far from its keyframes a submap is searched");
  fields.field("max_search_m", max_search_m, kPositive, "half of the largest search window");
  fields.field("min_inlier_share", min_inlier_share, kFraction,
               "least share of inliers among the beams on mapped walls");
  fields.field("min_mapped_share", min_mapped_share, kFraction,
               "least share of all beams that end on mapped walls");
  fields.field("min_score", min_score, kFraction, "least score of a place in the wide search");
  fields.field("runner_up_share", runner_up_share, kFraction,
               "of the best score: a higher runner-up makes a loop ambiguous");
  fields.field(
      "gate", gate, kPositive,
      "chi^2 (3 degrees of freedom) beyond which a loop is not explained by the covariance");
  fields.field("surprise_share", surprise_share, kFraction,
               "least inlier and mapped share of a loop beyond the gate");
}

void WaymarkConfig::describe(Fields& fields) {
  fields.field("keyframe_distance_m", keyframe_distance_m, kPositive,
               "a scan becomes a keyframe after this much driving");
  fields.field("keyframe_turn_rad", keyframe_turn_rad, kPositive, "or this much turning");
  fields.field("marker_keyframe_distance_m", marker_keyframe_distance_m, kPositive,
               "the same for a scan with sighted markers");
  fields.field("insert_distance_m", insert_distance_m, kNotNegative,
               "scans between keyframes are inserted into the submaps after this much driving");
  fields.field("window_keyframes", window_keyframes, {2, 100000},
               "keyframes in the window that is optimised; at most 16 with mode = localise");
  fields.field("submap_keyframes", submap_keyframes, {2, 100000}, "keyframes of a submap, at most");
  fields.field("submap_length_m", submap_length_m, {0.1, 1e4},
               "length of the path after which a submap ends");
  fields.field("keyframes_per_place", keyframes_per_place, {1, 100000},
               "kept per square metre and quarter of a turn; later ones are removed once others "
               "connect the trajectory to these");
  fields.field("learn_noise", learn_noise,
               "whether odometry noise and the rate of slips are learnt");
  fields.field("calibrate", calibrate,
               "whether systematic errors of odometry and camera are learnt; else they are 0");
  fields.field("marker_gate", marker_gate, kPositive,
               "chi^2 (3 degrees of freedom) of a marker's innovation that still associates it");
  fields.field("same_marker_within_m", same_marker_within_m, kPositive,
               "a known marker of the same id within this distance is associated even beyond the "
               "gate, with a smaller weight");
  fields.field("lost_inlier_share", lost_inlier_share, kFraction,
               "share of the mapped beams that must be inliers, else the robot is lost");
  fields.field("min_inlier_share", min_inlier_share, kFraction,
               "the same, else the scan is neither used nor mapped");
  fields.section("odometry", odometry);
  fields.section("scan", scan);
  fields.section("markers", markers);
  fields.section("loops", loops);
}

}  // namespace waymark

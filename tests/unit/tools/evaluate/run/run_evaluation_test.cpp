// SPDX-License-Identifier: BSD-3-Clause
// The sub-command `run` on a folder with the files of a run.
#include "evaluate/commands.hpp"
#include "unit/tools/evaluate/run/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::Not;

TEST(Run, WritesMetricsAndTheTable) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "waymark", 200, 1.0);
  add_estimator(run, "odometry", 202, 1.01);
  add_estimator(run, "marker_matching", 200, 1.005);
  run.file("waymark/markers.csv",
           "id,instance,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad,sightings\n"
           "0,0,3.02,1,-1.5708,0.1,0.1,0.1,7\n");
  run.file("waymark/config.toml", "[slam]\nseed = 7\n");
  run.file("waymark/timings.json", "{\"scan_ms\": 1.5}");
  run.file("waymark/covariance.csv", covariance_csv(kPoses, kUnitCovariance));

  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);

  const Json waymark = json_in(run.path() / "waymark/metrics.json");
  EXPECT_EQ(waymark["length_px"], 200.0);
  EXPECT_EQ(waymark["accuracy_percent"], 100.0);
  EXPECT_EQ(waymark["ate_origin_m"], 0.0);
  EXPECT_EQ(waymark["marker_error_mean_m"], 0.02);
  EXPECT_EQ(waymark["markers_missing"], 1);
  EXPECT_EQ(waymark["nees_poses"], kPoses);
  EXPECT_TRUE(waymark["max_jump_m"].is_number());
  EXPECT_TRUE(waymark["lifted_at_s"].is_null()) << "nobody lifted the robot";
  EXPECT_EQ(waymark["timings"]["scan_ms"], 1.5);
  const Json odometry = json_in(run.path() / "odometry/metrics.json");
  EXPECT_EQ(odometry["accuracy_percent"], 99.0);
  EXPECT_EQ(odometry["along_max_m"], 0.08);
  EXPECT_TRUE(odometry["nees_mean"].is_null());

  const Json results = json_in(run.path() / "results.json");
  ASSERT_EQ(results["estimators"].size(), 3u);
  EXPECT_EQ(results["estimators"][0]["estimator"], "odometry");
  EXPECT_EQ(results["estimators"][1]["estimator"], "marker_matching");
  EXPECT_EQ(results["estimators"][2]["config_toml"], "[slam]\nseed = 7\n");
  EXPECT_EQ(results["scenario_toml"], "[world]\nlength_m = 10\n");
  const std::string table = read_text(run.path() / "results.md");
  EXPECT_THAT(table, HasSubstr("| Case            | Pixel Length | Corridor Length | Pixel Count | "
                               "Map Length | Accuracy |\n"));
  EXPECT_THAT(table, HasSubstr("| marker_matching | 0.05 m/pixel | 10.0 m          | 200 pixel   | "
                               "10.00 m    | 100.00 % |\n"))
      << "the paper's columns stand alone";
  EXPECT_THAT(table, HasSubstr("| marker_matching | 0.023     | 0.50 "));
}

TEST(Run, NoLineOfTheTablesIsTooLongForATerminal) {
  const TemporaryFolder run;
  add_truth(run);
  run.file("scenario.toml",
           "[world]\nlength_m = 10\n[expect]\nate_origin_m = 0.01\nmarker_map_share = 0.9\n");
  add_estimator(run, "marker_matching_rotation_only", 200, 1.0);
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  for (const std::string& line : read_lines(run.path() / "results.md")) {
    if (line.starts_with("|")) {
      EXPECT_LE(line.size(), 180U) << line;
    }
  }
}

TEST(Run, RejectedAndLostMessagesAreFlaggedByTheirKind) {
  EstimatorResult result{};
  result.name = "waymark";
  const auto table_with = [&result](const std::string& counters) {
    result.timings_json = R"({"slam": {"counters": [)" + counters + "]}}";
    return error_table({result});
  };
  EXPECT_THAT(table_with(R"({"name": "rejected, dropped, late", "kind": "event", "value": 1})"),
              Not(HasSubstr("messages_")));
  EXPECT_THAT(table_with(R"({"name": "scans", "kind": "loss", "value": 1})"),
              HasSubstr("messages_lost"));
  EXPECT_THAT(table_with(R"({"name": "scans", "kind": "rejection", "value": 1})"),
              HasSubstr("messages_rejected"));
}

TEST(Run, ExpectationsHaveATableOfTheirOwn) {
  EstimatorResult result{};
  result.name = "waymark";
  EXPECT_EQ(expectation_table({result}), "");
  result.expectations = {{"ate_origin_m", 0.1, Limit::kAtMost, 0.02, true},
                         {"marker_map_share", 0.9, Limit::kAtLeast, std::nullopt, false}};
  EXPECT_EQ(expectation_table({result}),
            "| Row     | figure           | expected | got  |      |\n"
            "|---------|------------------|----------|------|------|\n"
            "| waymark | ate_origin_m     | <= 0.1   | 0.02 | hit  |\n"
            "| waymark | marker_map_share | >= 0.9   | none | MISS |\n");
}

TEST(Run, ARunWithInjectedFaultsIsMarked) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "waymark", 200, 1.0);
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  EXPECT_THAT(read_text(run.path() / "results.md"), Not(HasSubstr("Faults")));
  EXPECT_TRUE(json_in(run.path() / "results.json")["faults_toml"].is_null());

  run.file("variant_applied.toml", "[[variant]]\nname = \"ghosts\"\n");
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("Faults were put into"));
  EXPECT_EQ(json_in(run.path() / "results.json")["faults_toml"],
            "[[variant]]\nname = \"ghosts\"\n");
}

TEST(Run, AHugeNeesIsPrintedAsAPowerOfTen) {
  EstimatorResult calibrated{};
  calibrated.nees = Nees{.poses = 1, .mean = 999.0, .share_in_band = 0.0};
  EstimatorResult overconfident{};
  overconfident.nees = Nees{.poses = 1, .mean = 12'581'008'748.5, .share_in_band = 0.0};
  const std::string table = error_table({calibrated, overconfident});
  EXPECT_THAT(table, HasSubstr("| 999.00 |"));
  EXPECT_THAT(table, HasSubstr("| 1e+10  |"));
}

TEST(Run, AFinalTrajectoryHasItsOwnFiguresAndRow) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "gmapping", 200, 1.01);
  add_estimator(run, "odometry", 202, 1.02);
  run.file("gmapping/trajectory_final.tum", tum(0.0, 1.0));
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  const Json gmapping = json_in(run.path() / "gmapping/metrics.json");
  EXPECT_GT(gmapping["ate_origin_m"], 0.01);
  EXPECT_EQ(gmapping["final_ate_origin_m"], 0.0);
  EXPECT_EQ(gmapping["final_poses"], 81);
  EXPECT_TRUE(json_in(run.path() / "odometry/metrics.json")["final_ate_origin_m"].is_null());
  const std::string table = read_text(run.path() / "results.md");
  EXPECT_THAT(table, HasSubstr("| gmapping, final |"));
  EXPECT_THAT(table, Not(HasSubstr("odometry, final")));
}

// With a survey, the map's frame is the world's, so nothing is aligned.
TEST(Run, PosesInASurveysCoordinatesAreNotAligned) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "waymark", 200, 1.0);
  run.file("waymark/config.toml", "[robot.markers]\nsize_m = 0.4\nsurvey_file = \"s.csv\"\n");
  add_estimator(run, "odometry", 200, 1.0);
  run.file("odometry/config.toml", "[robot.markers]\nsurvey_file = \"\"\n");
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  const Json waymark = json_in(run.path() / "waymark/metrics.json");
  EXPECT_NEAR(waymark["ate_frame_m"].get<double>(), 1.0, 1e-9);  // the truth begins at x = 1 m
  EXPECT_NEAR(waymark["ate_origin_m"].get<double>(), 0.0, 1e-9);
  EXPECT_FALSE(json_in(run.path() / "odometry/metrics.json").contains("ate_frame_m"));
}

TEST(Run, MapChangesAreInTheResults) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "waymark", 200, 1.0);
  run.file("waymark/changes.csv", "change,id\nmarker_missing,7\nwall_gone,-1\n");
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  EXPECT_EQ(json_in(run.path() / "waymark/metrics.json")["changes"],
            (Json{"marker_missing,7", "wall_gone,-1"}));
  EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("waymark: 2 things are not as"));
}

TEST(Run, RowsStandInTheTablesOrder) {
  const TemporaryFolder run;
  for (const char* name : {"zeta", "waymark", "marker_matching_blank", "marker_matching", "alpha",
                           "gmapping_turtlebot3", "gmapping", "odometry"})
    run.file(std::string{name} + "/trajectory.tum", "");
  run.file("logs/slam.log", "");
  EXPECT_THAT(estimators_in(run.path()),
              ElementsAre("odometry", "gmapping", "gmapping_turtlebot3", "marker_matching",
                          "marker_matching_blank", "waymark", "alpha", "zeta"));
}

TEST(Run, WithoutTruthThereAreLengthsOnly) {
  const TemporaryFolder run;
  add_estimator(run, "odometry", 200, 1.0);
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  const Json metrics = json_in(run.path() / "odometry/metrics.json");
  EXPECT_EQ(metrics["length_m"], 10.0);
  EXPECT_TRUE(metrics["accuracy_percent"].is_null());
  EXPECT_TRUE(metrics["ate_origin_m"].is_null());
  EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("No truth.tum: lengths only"));
}

TEST(Run, AnEstimatorWithoutAMapIsAFailureOfThatRowOnly) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "odometry", 200, 1.0);
  run.file("waymark/trajectory.tum", tum(0.0, 1.0));
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitFailed);
  const Json waymark = json_in(run.path() / "waymark/metrics.json");
  EXPECT_TRUE(waymark["length_px"].is_null());
  EXPECT_EQ(waymark["ate_origin_m"], 0.0);
  EXPECT_THAT(waymark["problems"][0].get<std::string>(), HasSubstr("map.yaml: cannot be read"));
  EXPECT_EQ(run_run(run.path(), {"odometry"}, {}, kQuietly), kExitOk);
}

TEST(Run, MemoryIsCountedByMetreOfARobotThatHasDriven) {
  for (const double factor : {0.0, 1.0}) {
    const TemporaryFolder run;
    add_estimator(run, "waymark", 200, factor);
    run.file("scenario.toml", "[world]\nlength_m = 10\n");
    run.file("truth.tum", tum(1.0, factor));
    run.file("waymark/timings.json", "{\"slam\": {\"peak_memory_mb\": 40.0}}");
    run_run(run.path(), {}, {}, kQuietly);
    const Json metrics = json_in(run.path() / "waymark/metrics.json");
    if (factor == 0.0)
      EXPECT_TRUE(metrics["memory_mb_per_m"].is_null()) << metrics["memory_mb_per_m"];
    else
      EXPECT_NEAR(metrics["memory_mb_per_m"].get<double>(), 40.0 / 8.0, 1e-9);
  }
}

TEST(Run, SkippedLinesFailUnlessTolerated) {
  const TemporaryFolder run;
  add_truth(run);
  add_estimator(run, "odometry", 200, 1.0);
  run.file("odometry/trajectory.tum", tum(0.0, 1.0) + "garbage\n");
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitFailed);
  EXPECT_EQ(run_run(run.path(), {}, {}, Output{false, true}), kExitOk);
  EXPECT_EQ(json_in(run.path() / "odometry/metrics.json")["skipped"].size(), 1u);
}

TEST(Run, TruthOfAnotherRunIsAProblem) {
  const TemporaryFolder run;
  add_estimator(run, "odometry", 200, 1.0);
  run.file("truth.tum", "1000 0 0 0 0 0 0 1\n1001 0 0 0 0 0 0 1\n");
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitFailed);
  EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("within the truth's time span"));
  EXPECT_THAT(read_text(run.path() / "results.json"), Not(HasSubstr("nan")));
}

TEST(Run, AWorldWithCornersHasNoLength) {
  const TemporaryFolder run;
  add_truth(run);
  run.file("scenario.toml", "[world]\nlayout = \"L\"\nlength_m = 10\n");
  add_estimator(run, "waymark", 200, 1.0);
  EXPECT_EQ(run_run(run.path(), {}, {}, kQuietly), kExitOk);
  const Json metrics = json_in(run.path() / "waymark/metrics.json");
  EXPECT_TRUE(metrics["length_m"].is_null());
  EXPECT_TRUE(metrics["accuracy_percent"].is_null());
  EXPECT_EQ(metrics["ate_origin_m"], 0.0);
  EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("Not one straight corridor"));

  EvaluationOptions options{};
  options.true_length_m = 10.0;  // given by the user, so it is used
  EXPECT_EQ(run_run(run.path(), {}, options, kQuietly), kExitOk);
  EXPECT_EQ(json_in(run.path() / "waymark/metrics.json")["accuracy_percent"], 100.0);
}

TEST(Run, InvalidExpectationsAreNamedWithFileAndKey) {
  const TemporaryFolder run;
  add_estimator(run, "odometry", 200, 1.0);
  const auto problem_of = [&](const std::string& text) -> std::string {
    run.file("expect.toml", text);
    try {
      run_run(run.path(), {}, {}, kQuietly);
    } catch (const SetupError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem_of(""), "") << "nothing is expected";
  EXPECT_EQ(problem_of("[expect]\nate_origin_m = 0.1\n"), "");
  const std::string file = (run.path() / "expect.toml").string();
  EXPECT_EQ(problem_of("[expect]\nate_orgin_m = 0.1\n"),
            file + ":2: expect.ate_orgin_m: unknown key; did you mean expect.ate_origin_m?");
  EXPECT_EQ(problem_of("[expected]\nate_origin_m = 0.1\n"),
            file + ":1: expected: unknown key; did you mean expect?");
  EXPECT_THAT(problem_of("[expect]\nate_origin_m = true\n"),
              HasSubstr(file + ":2: expect.ate_origin_m: got true, expected a number"));
  for (const std::string number : {"nan", "inf", "-inf"})
    EXPECT_THAT(problem_of("[expect]\nate_origin_m = " + number + "\n"),
                HasSubstr(file + ":2: expect.ate_origin_m: got " + number));
}

TEST(Run, WhatCannotBeEvaluatedAtAllIsAUsageError) {
  const TemporaryFolder run;
  EXPECT_THROW(run_run(run.path() / "none", {}, {}, kQuietly), SetupError);
  EXPECT_THROW(run_run(run.path(), {}, {}, kQuietly), SetupError);
  add_estimator(run, "odometry", 200, 1.0);
  EXPECT_THROW(run_run(run.path(), {"gmapping"}, {}, kQuietly), SetupError);
  run.file("scenario.toml", "[world\n");
  EXPECT_THROW(run_run(run.path(), {}, {}, kQuietly), SetupError);
  run.file("scenario.toml", "[world]\nlength_m = \"long\"\n");
  EXPECT_THROW(run_run(run.path(), {}, {}, kQuietly), SetupError);
}

}  // namespace
}  // namespace waymark::evaluate

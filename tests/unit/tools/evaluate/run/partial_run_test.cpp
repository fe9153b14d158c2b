// SPDX-License-Identifier: BSD-3-Clause
// Runs in which estimates, covariances or expected figures are missing in part, and damaged files.
#include "unit/tools/evaluate/run/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;
using ::testing::Not;

/// A run of 16 s with the row `waymark`, which has no errors.
struct RunWithWaymark {
  TemporaryFolder folder{};

  RunWithWaymark() {
    add_truth(folder);
    add_estimator(folder, "waymark", 200, 1.0);
  }

  int evaluate() const { return run_run(folder.path(), {}, {}, kQuietly); }

  Json metrics() const { return json_in(folder.path() / "waymark/metrics.json"); }

  std::string table() const { return read_text(folder.path() / "results.md"); }

  std::vector<std::string> list(const char* key) const {
    return metrics()[key].get<std::vector<std::string>>();
  }
};

TEST(PartOfARun, AnEstimateThatStopsEarlyIsAProblem) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.0, 41));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_EQ(run.metrics()["truth_covered_share"], 0.5);
  EXPECT_THAT(run.list("problems"),
              ElementsAre(HasSubstr("trajectory.tum: covers 50.0 % of the truth's time")));
  EXPECT_THAT(run.table(), HasSubstr("| incomplete part_of_run |"));
}

TEST(PartOfARun, TheLastFewPosesMayBeMissing) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.0, kPoses - 3));
  EXPECT_EQ(run.evaluate(), kExitOk);
  EXPECT_THAT(run.list("problems"), IsEmpty());
}

TEST(PartOfARun, AFinalTrajectoryIsCheckedLikeThePublishedOne) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory_final.tum", tum(0.0, 1.0, 41));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_EQ(run.metrics()["truth_covered_share"], 1.0);
  EXPECT_EQ(run.metrics()["final_truth_covered_share"], 0.5);
  EXPECT_THAT(run.list("problems"), ElementsAre(HasSubstr("trajectory_final.tum: covers 50.0 %")));

  run.folder.file("waymark/trajectory_final.tum", tum(0.0, 1.0, 2 * kPoses));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_THAT(run.list("problems"),
              ElementsAre(HasSubstr("trajectory_final.tum: 81 of 162 poses are outside")));
}

TEST(PartOfARun, ALateFirstPoseIsANoteNotAProblem) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.0, 61, 20));
  EXPECT_EQ(run.evaluate(), kExitOk);
  EXPECT_EQ(run.metrics()["first_pose_s"], 4.0);
  EXPECT_THAT(run.list("problems"), IsEmpty());
  EXPECT_THAT(run.list("notes"), ElementsAre(HasSubstr("begins 4.0 s after the truth")));
  EXPECT_THAT(run.table(), HasSubstr("* waymark: trajectory.tum begins 4.0 s after the truth"));
}

TEST(PartOfARun, AnEstimateOfLessThanTheSecondHalfIsAProblem) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.0, 31, 50));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_THAT(run.list("problems"), ElementsAre(HasSubstr("begins 10.0 s after the truth")));
}

TEST(PartOfARun, ASinglePoseHasNoError) {
  const RunWithWaymark run;
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.0, 1));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_TRUE(run.metrics()["ate_origin_m"].is_null());
  EXPECT_TRUE(run.metrics()["truth_covered_share"].is_null());
  EXPECT_THAT(run.list("problems"), ElementsAre(HasSubstr("fewer than two poses")));
}

TEST(PartOfARun, TheTrajectoryCommandFailsUnlessTolerant) {
  const TemporaryFolder folder;
  const auto whole = folder.file("whole.tum", tum(1.0, 1.0));
  const auto code = [&](int poses, int first, const Output& output) {
    return run_trajectory(folder.file("part.tum", tum(0.0, 1.0, poses, first)), whole,
                          Alignment::kOrigin, output);
  };
  const Output tolerantly{false, true};
  EXPECT_EQ(code(kPoses, 0, kQuietly), kExitOk);
  EXPECT_EQ(code(41, 0, kQuietly), kExitFailed);
  EXPECT_EQ(code(41, 0, tolerantly), kExitOk);
  EXPECT_EQ(code(kPoses, 10, kQuietly), kExitFailed) << "10 of 81 poses are after the reference";
  EXPECT_THROW(code(1, 0, tolerantly), SetupError);
}

TEST(PartOfARun, AnExpectedFigureThatIsMissingGives1) {
  const RunWithWaymark run;
  run.folder.file("expect.toml", "[expect]\nate_origin_m = 0.1\n");
  EXPECT_EQ(run.evaluate(), kExitOk);
  run.folder.file("expect.toml", "[expect]\nate_origin_m = 1e-12\nacross_rmse_m = 1e-12\n");
  run.folder.file("waymark/trajectory.tum", tum(0.0, 1.01));
  EXPECT_EQ(run.evaluate(), kExitOk) << "a miss is a result";
  run.folder.file("expect.toml", "[expect]\nnees_mean = 6\n");  // without a covariance.csv
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_THAT(run.table(), HasSubstr("| nees_mean | <= 6     | none | MISS |"));
}

TEST(PartOfARun, PosesWithoutAUsableCovarianceAreAProblem) {
  const RunWithWaymark run;
  run.folder.file("waymark/covariance.csv", covariance_csv(kPoses, kUnitCovariance));
  EXPECT_EQ(run.evaluate(), kExitOk);

  run.folder.file("waymark/covariance.csv", covariance_csv(60, kUnitCovariance));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_EQ(run.metrics()["nees_missing"], 21);
  EXPECT_THAT(run.list("problems"), ElementsAre(HasSubstr("of 81 poses, 21 have no covariance")));

  run.folder.file("waymark/covariance.csv", covariance_csv(kPoses, "-1,0,0,1,0,1"));
  EXPECT_EQ(run.evaluate(), kExitFailed);
  EXPECT_EQ(run.metrics()["nees_invalid"], kPoses);
}

// Coinciding particles have a singular covariance: a result, not a damaged file.
TEST(PartOfARun, SingularCovariancesAreNamedAndMeetNoExpectation) {
  const RunWithWaymark run;
  run.folder.file("waymark/covariance.csv", covariance_csv(kPoses, "0,0,0,1,0,1"));
  EXPECT_EQ(run.evaluate(), kExitOk);
  EXPECT_THAT(run.list("notes"), ElementsAre(HasSubstr("81 of 81 covariances are singular")));
  run.folder.file("expect.toml", "[expect]\nnees_mean = 6\n");
  EXPECT_EQ(run.evaluate(), kExitFailed);
}

TEST(SurveyedRun, OnlyANewMapOfWaymarkIsInTheSurveysFrame) {
  const std::string survey = "[robot.markers]\nsurvey_file = \"s.csv\"\n[slam]\n";
  const auto is_in_frame = [&](const std::string& slam) {
    const RunWithWaymark run;
    run.folder.file("waymark/config.toml", survey + slam);
    EXPECT_EQ(run.evaluate(), kExitOk);
    return run.metrics().contains("ate_frame_m");
  };
  EXPECT_TRUE(is_in_frame("estimator = \"waymark\"\nmode = \"map\"\n"));
  EXPECT_FALSE(is_in_frame("estimator = \"odometry\"\n"));
  EXPECT_FALSE(is_in_frame("estimator = \"waymark\"\nmode = \"localise\"\n"));
  EXPECT_FALSE(is_in_frame("estimator = \"waymark\"\nmode = \"extend\"\n"));
}

TEST(SurveyedRun, TheTableNamesRowsThatAreAlignedOtherwise) {
  const RunWithWaymark run;
  add_estimator(run.folder, "odometry", 200, 1.0);
  EXPECT_EQ(run.evaluate(), kExitOk);
  EXPECT_THAT(run.table(), HasSubstr("aligned by `origin`; "));
  run.folder.file("waymark/config.toml", "[robot.markers]\nsurvey_file = \"s.csv\"\n");
  EXPECT_EQ(run.evaluate(), kExitOk);
  EXPECT_THAT(run.table(), HasSubstr("aligned by `origin`, of waymark by `frame`; "));
}

TEST(DamagedFile, CountersOfAnotherFormAreAProblemOfTheirRow) {
  const RunWithWaymark run;
  for (const char* counters : {"[1]", "{\"kind\": 1}", "7", "[{\"kind\": 1}]"}) {
    run.folder.file("waymark/timings.json",
                    fmt::format("{{\"slam\": {{\"counters\": {}}}}}", counters));
    EXPECT_EQ(run.evaluate(), kExitFailed) << counters;
    EXPECT_THAT(run.list("problems"), ElementsAre(HasSubstr("timings.json: slam.counters")));
  }
}

}  // namespace
}  // namespace waymark::evaluate

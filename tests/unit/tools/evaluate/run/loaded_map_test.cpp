// SPDX-License-Identifier: BSD-3-Clause
// A run evaluated in the frame of the map that another run made.
#include "evaluate/run/loaded_map.hpp"

#include "unit/tools/evaluate/run/run_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::evaluate {
namespace {

using ::testing::HasSubstr;
using ::testing::Optional;

constexpr const char* kColumns = "id,instance,x_m,y_m,yaw_rad\n";

TEST(LoadedMap, ErrorsAreInTheFrameOfTheRunThatMadeTheMap) {
  const TemporaryFolder mapping;
  const TemporaryFolder run;
  for (const TemporaryFolder* folder : {&mapping, &run}) {
    add_truth(*folder);
    add_estimator(*folder, "waymark", 200, 1.0);
    folder->file("waymark/markers.csv",
                 std::string{kColumns} + "0,0,3,1,0\n1,0,7,1,0\n2,0,9,1,0\n");
  }
  // One marker of three was moved since.
  run.file("waymark/markers.csv", std::string{kColumns} + "0,0,3,1,0\n1,0,6,1,0\n2,0,9,1.05,0\n");
  EvaluationOptions options{};
  options.mapped_in = mapping.path();
  EXPECT_EQ(run_run(run.path(), {}, options, kQuietly), kExitOk);
  EXPECT_EQ(json_in(run.path() / "waymark/metrics.json")["ate_frame_m"], 0.0);
}

TEST(LoadedMap, ATransformedOrUnrelatedMapIsAProblemAndNoError) {
  const TemporaryFolder mapping;
  const TemporaryFolder run;
  for (const TemporaryFolder* folder : {&mapping, &run}) {
    add_truth(*folder);
    add_estimator(*folder, "waymark", 200, 1.0);
  }
  mapping.file("waymark/markers.csv", std::string{kColumns} + "0,0,3,1,0\n1,0,7,1,0\n");
  EvaluationOptions options{};
  options.mapped_in = mapping.path();
  for (const char* other : {"0,0,103,-49,0\n1,0,107,-49,0\n", "8,0,3,1,0\n9,0,7,1,0\n"}) {
    run.file("waymark/markers.csv", std::string{kColumns} + other);
    EXPECT_EQ(run_run(run.path(), {}, options, kQuietly), kExitFailed) << other;
    const Json metrics = json_in(run.path() / "waymark/metrics.json");
    EXPECT_FALSE(metrics.contains("ate_frame_m")) << other;
    EXPECT_THAT(read_text(run.path() / "results.md"), HasSubstr("not in the frame of the one"));
  }
}

TEST(LoadedMap, SaysHowFarTheMarkersLieApart) {
  const std::vector<Marker> made{{.id = 0, .parent_from_marker = {3.0, 1.0, 0.0}},
                                 {.id = 1, .parent_from_marker = {7.0, 1.0, 0.0}}};
  const std::vector<Marker> moved{{.id = 0, .parent_from_marker = {3.0, 3.0, 0.0}},
                                  {.id = 1, .parent_from_marker = {7.0, 1.0, 0.0}}};
  EXPECT_EQ(difference_of(made, made), std::nullopt);
  EXPECT_EQ(difference_of(made, {}), std::nullopt) << "a map without markers";
  EXPECT_THAT(difference_of(moved, made), Optional(HasSubstr("1 of 2")));
  EXPECT_THAT(difference_of(moved, made), Optional(HasSubstr("2.00 m")));
}

}  // namespace
}  // namespace waymark::evaluate

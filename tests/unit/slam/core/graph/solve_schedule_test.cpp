// SPDX-License-Identifier: BSD-3-Clause
// When the whole graph is solved.
#include "slam/core/graph/solve_schedule.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

constexpr double kMoved = 0.1;

/// Keyframes until a step is due, at most so many.
int keyframes_until_due(SolveSchedule& schedule, std::size_t from, int most) {
  for (int i = 1; i <= most; ++i)
    if (schedule.advance(from + static_cast<std::size_t>(i))) return i;
  return most + 1;
}

TEST(SolveSchedule, NothingIsDueWithoutLoops) {
  SolveSchedule schedule;
  EXPECT_GT(keyframes_until_due(schedule, 0, 1000), 1000);
}

TEST(SolveSchedule, AfterALoopAStepIsDueAtOnceIfTheGraphHasGrown) {
  SolveSchedule schedule;
  schedule.note_loop(true);
  EXPECT_TRUE(schedule.advance(1000));
  EXPECT_EQ(schedule.num_since_solution(1000), 0U);
}

TEST(SolveSchedule, SolvingStopsWhenAStepMovesNothing) {
  SolveSchedule schedule;
  schedule.note_loop(true);
  EXPECT_TRUE(schedule.advance(1000));
  schedule.note_step(kMoved);
  EXPECT_TRUE(schedule.advance(1001));
  schedule.note_step(0.0);
  EXPECT_FALSE(schedule.advance(1002));
}

TEST(SolveSchedule, SolvingTakesABoundedNumberOfSteps) {
  SolveSchedule schedule;
  schedule.note_loop(true);
  for (int i = 0; i < SolveSchedule::kSteps; ++i) {
    EXPECT_TRUE(schedule.advance(1000));
    schedule.note_step(kMoved);
  }
  EXPECT_FALSE(schedule.advance(1000));
}

TEST(SolveSchedule, LoopsThatConfirmThePoseWaitLongerThanContradictions) {
  const auto wait = [](bool contradicts_pose) {
    SolveSchedule schedule;
    schedule.note_loop(true);
    EXPECT_TRUE(schedule.advance(4000));
    schedule.note_step(0.0);
    schedule.note_loop(contradicts_pose);
    return keyframes_until_due(schedule, 4000, 1000);
  };
  EXPECT_EQ(wait(true), 20);    // 1/200 of all
  EXPECT_EQ(wait(false), 571);  // an eighth of all, which grow meanwhile
}

}  // namespace
}  // namespace waymark

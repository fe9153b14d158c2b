// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/relocalisation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

using Verdict = RelocalisationMonitor::Verdict;

const Se2 kBelieved{10.0, 0.0, 0.0};
const Se2 kElsewhere{5.0, 0.0, 0.0};

PoseHint elsewhere(int id) {
  return {PoseHint::Kind::kElsewhere, id, kElsewhere};
}

PoseHint agreeing(int id) {
  return {PoseHint::Kind::kAgrees, id, {}};
}

PoseHint unexpected(int id) {
  return {PoseHint::Kind::kNew, id, {}, true};
}

TEST(RelocalisationMonitor, OneMarkerElsewhereIsADoubt) {
  RelocalisationMonitor monitor;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(monitor.judge(kBelieved, std::vector{elsewhere(3)}, {}), Verdict::kDoubtful);
}

TEST(RelocalisationMonitor, TwoMarkersThatAgreeDecide) {
  RelocalisationMonitor monitor;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  EXPECT_EQ(monitor.judge(kBelieved, pair, {}), Verdict::kDoubtful);
  EXPECT_EQ(monitor.judge(kBelieved, pair, {}), Verdict::kElsewhere);
  EXPECT_EQ(monitor.map_from_base().x(), kElsewhere.x());
  EXPECT_EQ(monitor.judge(kElsewhere, std::vector{agreeing(3)}, {}), Verdict::kSettled);
}

TEST(RelocalisationMonitor, AMarkerWhereItIsExpectedEndsTheDoubt) {
  RelocalisationMonitor monitor;
  EXPECT_EQ(monitor.judge(kBelieved, std::vector{elsewhere(3)}, {}), Verdict::kDoubtful);
  EXPECT_EQ(monitor.judge(kBelieved, std::vector{elsewhere(3), agreeing(5)}, {}),
            Verdict::kSettled);
}

TEST(RelocalisationMonitor, AMisreadIdIsForgottenSoon) {
  RelocalisationMonitor monitor;
  EXPECT_EQ(monitor.judge(kBelieved, std::vector{elsewhere(3)}, {}), Verdict::kDoubtful);
  const Motion onwards{{1.0, 0.0, 0.0}, 1.0, 0.0};
  EXPECT_EQ(monitor.judge(kBelieved, {}, onwards), Verdict::kSettled);
}

TEST(RelocalisationMonitor, TwoUnexpectedNewMarkersUndoARelocalisation) {
  RelocalisationMonitor monitor;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  monitor.judge(kBelieved, pair, {});
  ASSERT_EQ(monitor.judge(kBelieved, pair, {}), Verdict::kElsewhere);
  const Motion onwards{{1.0, 0.0, 0.0}, 1.0, 0.0};
  EXPECT_EQ(monitor.judge(kElsewhere, std::vector{unexpected(20), unexpected(21)}, onwards),
            Verdict::kBack);
  EXPECT_NEAR(monitor.map_from_base().x(), kBelieved.x() + 1.0, 1e-9);
}

}  // namespace
}  // namespace waymark

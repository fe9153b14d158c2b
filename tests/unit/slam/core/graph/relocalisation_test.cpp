// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/relocalisation.hpp"

#include <gtest/gtest.h>

#include <vector>

namespace waymark {
namespace {

using Verdict = RelocalisationMonitor::Verdict;

const Se2 kConsecutive{10.0, 0.0, 0.0};
const Se2 kElsewhere{5.0, 0.0, 0.0};

PoseHint elsewhere(int id) {
  return {PoseHint::Kind::kElsewhere, id, kElsewhere};
}

PoseHint as_expected(int id) {
  return {PoseHint::Kind::kAgrees, id, {}};
}

PoseHint unexpected(int id) {
  return {PoseHint::Kind::kNew, id, {}, true};
}

TEST(RelocalisationMonitor, OneMarkerElsewhereIsSuspicious) {
  RelocalisationMonitor monitor;
  for (int i = 0; i < 5; ++i)
    EXPECT_EQ(monitor.update(kConsecutive, std::vector{elsewhere(3)}, {}), Verdict::kSuspicious);
}

TEST(RelocalisationMonitor, TwoMarkersThatAgreeRelocate) {
  RelocalisationMonitor monitor;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  EXPECT_EQ(monitor.update(kConsecutive, pair, {}), Verdict::kSuspicious);
  EXPECT_EQ(monitor.update(kConsecutive, pair, {}), Verdict::kRelocated);
  EXPECT_EQ(monitor.map_from_base().x(), kElsewhere.x());
  EXPECT_EQ(monitor.update(kElsewhere, std::vector{as_expected(3)}, {}), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, AMarkerWhereItIsExpectedEndsTheSuspicion) {
  RelocalisationMonitor monitor;
  EXPECT_EQ(monitor.update(kConsecutive, std::vector{elsewhere(3)}, {}), Verdict::kSuspicious);
  EXPECT_EQ(monitor.update(kConsecutive, std::vector{elsewhere(3), as_expected(5)}, {}),
            Verdict::kConsistent);
}

TEST(RelocalisationMonitor, AMisreadIdIsDroppedSoon) {
  RelocalisationMonitor monitor;
  EXPECT_EQ(monitor.update(kConsecutive, std::vector{elsewhere(3)}, {}), Verdict::kSuspicious);
  const Motion onwards{{1.0, 0.0, 0.0}, 1.0, 0.0};
  EXPECT_EQ(monitor.update(kConsecutive, {}, onwards), Verdict::kConsistent);
}

TEST(RelocalisationMonitor, TwoUnexpectedIdsRevertARelocalisation) {
  RelocalisationMonitor monitor;
  const std::vector pair{elsewhere(3), elsewhere(4)};
  monitor.update(kConsecutive, pair, {});
  ASSERT_EQ(monitor.update(kConsecutive, pair, {}), Verdict::kRelocated);
  const Motion onwards{{1.0, 0.0, 0.0}, 1.0, 0.0};
  EXPECT_EQ(monitor.update(kElsewhere, std::vector{unexpected(20), unexpected(21)}, onwards),
            Verdict::kReverted);
  EXPECT_NEAR(monitor.map_from_base().x(), kConsecutive.x() + 1.0, 1e-9);
}

}  // namespace
}  // namespace waymark

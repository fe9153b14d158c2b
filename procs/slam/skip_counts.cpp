// SPDX-License-Identifier: BSD-3-Clause
#include "slam/skip_counts.hpp"

#include <array>
#include <cstddef>

namespace waymark {
namespace {

struct CountedSkip {
  Skip skip{};
  SkipCount count{};
};

constexpr auto kCounts = std::to_array<CountedSkip>({
    {Skip::kOdometryOutOfOrder, {"odometry out of order", CountKind::kLoss}},
    {Skip::kOdometryAhead, {"odometry rejected: time jumps ahead", CountKind::kRejection}},
    {Skip::kClockSet, {"clock was set", CountKind::kEvent}},
    {Skip::kOdometryJumped, {"odometry jumps", CountKind::kEvent}},
    {Skip::kOdometryStuck,
     {"odometry catching up after it was stuck or jumped", CountKind::kEvent}},
    {Skip::kScanOutOfOrder, {"scans out of order", CountKind::kLoss}},
    {Skip::kScanAhead, {"scans dropped: stamped ahead", CountKind::kLoss}},
    {Skip::kScanWithoutReturns, {"scans without returns", CountKind::kEvent}},
    {Skip::kScanRepeated, {"scans that repeat one from another place", CountKind::kEvent}},
    {Skip::kScanBeforeOdometry, {"scans before the first odometry", CountKind::kEvent}},
    {Skip::kScanWithoutOdometry, {"scans after the last odometry", CountKind::kEvent}},
    {Skip::kScanOverflow, {"scans dropped waiting for odometry", CountKind::kLoss}},
    {Skip::kFrameOutOfOrder, {"camera frames out of order", CountKind::kLoss}},
    {Skip::kFrameAhead, {"camera frames dropped: stamped ahead", CountKind::kLoss}},
    {Skip::kFrameWithoutOdometry,
     {"camera frames dropped: too late, or before the first odometry", CountKind::kLoss}},
    {Skip::kFrameOverflow, {"camera frames dropped waiting for a scan", CountKind::kLoss}},
    {Skip::kFrameRepeated, {"camera frames that repeat the previous one", CountKind::kEvent}},
    {Skip::kMarkerImplausible, {"markers not upright", CountKind::kEvent}},
    {Skip::kMarkerUncertain, {"markers too uncertain", CountKind::kEvent}},
});

constexpr bool has_every_skip_in_order() {
  for (std::size_t i = 0; i < kCounts.size(); ++i)
    if (kCounts[i].skip != static_cast<Skip>(i)) return false;
  return kCounts.back().skip == Skip::kMarkerUncertain;
}

static_assert(has_every_skip_in_order());

}  // namespace

SkipCount count_of(Skip skip) {
  return kCounts[static_cast<std::size_t>(skip)].count;
}

}  // namespace waymark

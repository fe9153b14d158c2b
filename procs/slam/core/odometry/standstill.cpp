// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/odometry/standstill.hpp"

#include <cmath>

namespace waymark {
namespace {

// Odometry that stands still is stuck if the estimate moves by more than this.
constexpr double kMoved_m = 0.03;
constexpr double kMoved_rad = 0.05;
// A scan was mismatched, and odometry is not stuck, if the estimate was never farther than this
// from where odometry came to a standstill, and has come back to kReturned of the largest distance.
constexpr double kNearStandstill_m = 0.3;
constexpr double kNearStandstill_rad = 0.2;
constexpr double kReturned = 0.7;

}  // namespace

std::optional<Standstill::Observed> Standstill::compare(const Se2& map_from_base, double clock_s) {
  const Eigen::Vector3d moved = pose_difference(map_from_base, map_from_moved_);
  const double moved_m = moved.head<2>().norm();
  if (moved_m < kMoved_m && std::abs(moved.z()) < kMoved_rad) return std::nullopt;
  const Eigen::Vector3d away = pose_difference(map_from_base, map_from_start_).cwiseAbs();
  farthest_ = farthest_.cwiseMax(away);
  const double farthest_m = farthest_.head<2>().norm();
  const double farthest_rad = farthest_.z();
  const bool was_near = farthest_m < kNearStandstill_m && farthest_rad < kNearStandstill_rad;
  const bool has_returned = was_near && away.head<2>().norm() <= kReturned * farthest_m &&
                            away.z() <= kReturned * farthest_rad;
  const double elapsed_s = clock_s - moved_at_s_;
  map_from_moved_ = map_from_base;
  moved_at_s_ = clock_s;
  return Observed{moved_m, elapsed_s, has_returned};
}

}  // namespace waymark

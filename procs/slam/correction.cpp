// SPDX-License-Identifier: BSD-3-Clause
#include "slam/correction.hpp"

#include "common/geometry/se2.hpp"

namespace waymark {
namespace {

using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;

static_assert(static_cast<int>(EstimateReason::kOdometry) == correction_t::REASON_ODOMETRY &&
              static_cast<int>(EstimateReason::kScan) == correction_t::REASON_SCAN &&
              static_cast<int>(EstimateReason::kMarker) == correction_t::REASON_MARKER &&
              static_cast<int>(EstimateReason::kLoop) == correction_t::REASON_LOOP &&
              static_cast<int>(EstimateReason::kRelocalised) == correction_t::REASON_RELOCALISED &&
              static_cast<int>(EstimateReason::kSurvey) == correction_t::REASON_SURVEY &&
              static_cast<int>(EstimateReason::kCommand) == correction_t::REASON_COMMAND);

}  // namespace

correction_t CorrectionMaker::make(const Estimate& estimate, const Se2& odom_from_base,
                                   std::int64_t map_id) {
  const Se2 map_from_odom = estimate.map_from_base * odom_from_base.inverse();
  const Se2 by_the_one_before = before_.value_or(map_from_odom) * odom_from_base;
  before_ = map_from_odom;
  correction_t message{};
  message.utime = to_us(estimate.time);
  message.map_id = map_id;
  message.x_m = map_from_odom.x();
  message.y_m = map_from_odom.y();
  message.theta_rad = map_from_odom.theta();
  // The odometry pose is exact here: the covariance is the estimate's, for the lever arm to the
  // odometry's origin.
  Eigen::Map<RowMajor3>{message.covariance} = at_end_of_lever(
      estimate.covariance, map_from_odom.translation() - estimate.map_from_base.translation());
  message.health = static_cast<std::int8_t>(estimate.health);
  Eigen::Map<Eigen::Vector3d>{message.jump} =
      pose_difference(estimate.map_from_base, by_the_one_before);
  message.reason = static_cast<std::int8_t>(estimate.reason);
  return message;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/input/skip.hpp"

namespace waymark {

std::string_view to_string(Skip skip) {
  switch (skip) {
    case Skip::kOdometryOutOfOrder:
      return "odometry out of order";
    case Skip::kOdometryAhead:
      return "odometry rejected: time jumps ahead";
    case Skip::kClockSet:
      return "clock was set";
    case Skip::kOdometryJumped:
      return "odometry jumps";
    case Skip::kOdometryStuck:
      return "odometry catching up after it was stuck or jumped";
    case Skip::kScanOutOfOrder:
      return "scans out of order";
    case Skip::kScanAhead:
      return "scans dropped: stamped ahead";
    case Skip::kScanWithoutReturns:
      return "scans without returns";
    case Skip::kScanRepeated:
      return "scans that repeat one from another place";
    case Skip::kScanBeforeOdometry:
      return "scans before the first odometry";
    case Skip::kScanWithoutOdometry:
      return "scans after the last odometry";
    case Skip::kScanOverflow:
      return "scans dropped waiting for odometry";
    case Skip::kFrameOutOfOrder:
      return "camera frames out of order";
    case Skip::kFrameAhead:
      return "camera frames dropped: stamped ahead";
    case Skip::kFrameWithoutOdometry:
      return "camera frames dropped: too late, or before the first odometry";
    case Skip::kFrameOverflow:
      return "camera frames dropped waiting for a scan";
    case Skip::kFrameRepeated:
      return "camera frames that repeat the previous one";
    case Skip::kMarkerImplausible:
      return "markers not upright";
    case Skip::kMarkerUncertain:
      return "markers too uncertain";
  }
  return "unknown";
}

}  // namespace waymark

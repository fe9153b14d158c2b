// SPDX-License-Identifier: BSD-3-Clause
// Every message type once, by index: the first byte of an input of the target `messages`.
#pragma once

#include "common/messages/channels.hpp"

#include <tuple>

namespace waymark::fuzz {

inline constexpr auto kTypes = std::tuple{channels::kAck,
                                          channels::kSlamScan,
                                          channels::kMapCalibration,
                                          channels::kSlamCommand,
                                          channels::kSlamCorrection,
                                          channels::kCamera,
                                          channels::kMbotLidar,
                                          channels::kSlamChanges,
                                          channels::kMapHeader,
                                          channels::kSlamMap,
                                          channels::kMapWalls,
                                          channels::kMarkers,
                                          channels::kSlamMarkers,
                                          channels::kMbotSystemReset,
                                          channels::kSlamGrid,
                                          channels::kSlamParticles,
                                          channels::kLidar,
                                          channels::kOdometry,
                                          channels::kMapGraph,
                                          channels::kSimStatus,
                                          channels::kSlamReply,
                                          channels::kSlamEstimate,
                                          channels::kMbotSlamStatus,
                                          channels::kTick,
                                          channels::kSlamTrajectory,
                                          channels::kDriveCommand,
                                          channels::kSlamFindings};

/// Calls `visit(index, channel)` for each.
template <class Visit>
void for_each_type(Visit visit) {
  std::apply(
      [&](const auto&... channel) {
        std::size_t index = 0;
        (visit(index++, channel), ...);
      },
      kTypes);
}

}  // namespace waymark::fuzz

// SPDX-License-Identifier: BSD-3-Clause
// Physical bounds: a message with a value beyond them is rejected.
#pragma once

#include <cstdint>

namespace waymark::bounds {

// Each is the largest absolute value of:

/// Positions in any frame. UTM's northings of GNSS frames fit.
inline constexpr double kPosition_m = 1e7;
/// Coordinates in a map, also in one whose origin is a survey's. Poses are sent in single
/// precision, too (pose2D_t), which has steps of 1 mm at this limit.
inline constexpr double kMapCoordinate_m = 16'384.0;
/// Beam angles and headings. Some odometries do not wrap headings: this is 1.6 million turns.
inline constexpr double kAngle_rad = 1e7;
/// LiDAR ranges. LiDARs of robots measure some hundred metres at most.
inline constexpr double kRange_m = 1e4;
/// Drive commands. No ground robot is as fast.
inline constexpr double kSpeed_mps = 100.0;
inline constexpr double kTurnRate_radps = 100.0;
/// Cell sizes, marker sizes and spacings.
inline constexpr double kLength_m = 1e3;
/// Coordinates of a marker's corners, which may lie outside the image.
inline constexpr double kPixel_px = 1e6;

inline constexpr int kImageSide_px = 16384;
inline constexpr int kBeams = 16384;
/// A beam's time relative to its scan's. A sweep takes far less than 10 s.
inline constexpr std::int64_t kBeamTimeOffset_us = 10'000'000;
/// Indices of tiles and (below) cells, which count from the map's origin.
inline constexpr int kTileIndex = 1 << 20;
inline constexpr int kTileSize_cells = 1024;
inline constexpr int kCellIndex = 1 << 24;
/// Message times: the beginning of 2100.
inline constexpr std::int64_t kTime_us = 4'102'444'800'000'000;

}  // namespace waymark::bounds

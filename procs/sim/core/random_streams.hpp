// SPDX-License-Identifier: BSD-3-Clause
// One number per source of randomness: the second part of a Random's key, after the seed.
#pragma once

#include <cstdint>

namespace waymark::random_streams {

inline constexpr std::uint64_t kOdometryConstants = 1;
inline constexpr std::uint64_t kOdometry = 2;
inline constexpr std::uint64_t kLidar = 3;
inline constexpr std::uint64_t kCameraTile = 4;
inline constexpr std::uint64_t kCameraFrame = 5;
inline constexpr std::uint64_t kMissingMarkers = 6;
inline constexpr std::uint64_t kLostMeasurements = 7;
inline constexpr std::uint64_t kGarbage = 8;
inline constexpr std::uint64_t kCameraErrors = 9;

}  // namespace waymark::random_streams

// SPDX-License-Identifier: BSD-3-Clause
// LCM payloads of other robots, written byte by byte.
#pragma once

#include <array>
#include <bit>
#include <cstdint>
#include <vector>

namespace waymark {

class PayloadWriter {
 public:
  explicit PayloadWriter(std::uint64_t fingerprint) { put(fingerprint); }

  template <class Unsigned>
  PayloadWriter& put(Unsigned value) {
    for (int shift = 8 * (static_cast<int>(sizeof(Unsigned)) - 1); shift >= 0; shift -= 8)
      bytes_.push_back(static_cast<std::uint8_t>(value >> shift));
    return *this;
  }

  PayloadWriter& put_double(double value) { return put(std::bit_cast<std::uint64_t>(value)); }

  std::vector<std::uint8_t> take() { return std::move(bytes_); }

 private:
  std::vector<std::uint8_t> bytes_{};
};

inline std::vector<std::uint8_t> maebot_encoders(std::int64_t utime_us, std::int32_t left,
                                                 std::int32_t right) {
  return PayloadWriter{0x7d090bfb221d74f9ULL}
      .put(static_cast<std::uint64_t>(utime_us))
      .put(static_cast<std::uint32_t>(left))
      .put(static_cast<std::uint32_t>(right))
      .take();
}

/// MAEBot of 2014: motor currents and commands behind the ticks.
inline std::vector<std::uint8_t> maebot_motor_feedback(std::int64_t utime_us, std::int32_t left,
                                                       std::int32_t right) {
  PayloadWriter writer{0x8dc5a028fca42ff9ULL};
  writer.put(static_cast<std::uint64_t>(utime_us))
      .put(static_cast<std::uint32_t>(left))
      .put(static_cast<std::uint32_t>(right));
  for (std::uint32_t other = 0; other < 7; ++other)
    writer.put(other);
  return writer.take();
}

/// bot_core.pose_t at (x, y, 9 m), turned about z by the quaternion (w, 0, 0, z).
inline std::vector<std::uint8_t> bot_core_pose(std::int64_t utime_us, double x_m, double y_m,
                                               double w, double z) {
  PayloadWriter writer{0x2e16efb052b0105eULL};
  writer.put(static_cast<std::uint64_t>(utime_us));
  const std::array<double, 16> numbers{x_m, y_m, 9.0, 1, 2, 3, w, 0, 0, z, 4, 5, 6, 7, 8, 9};
  for (const double number : numbers)
    writer.put_double(number);
  return writer.take();
}

}  // namespace waymark

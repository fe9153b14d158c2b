// SPDX-License-Identifier: BSD-3-Clause
// Brings messages of one log whose stamps are from different clocks onto one clock.
#pragma once

#include "import/log/imported_log.hpp"

#include <string_view>
#include <vector>

namespace waymark {

/// Compares the stamps of a channel's messages with the times at which the logger received them.
class ChannelClock {
 public:
  void add(Timestamp stamp, Timestamp logged);

  bool empty() const { return logger_minus_stamp_us_.empty(); }

  /// Median of logger time minus stamp. @pre !empty()
  Duration logger_ahead() const;

  /// Whether the durations of the log by stamps and by the logger's clock differ by less than a
  /// factor of two. If not, one of the clocks is unusable, and so is their offset.
  bool is_comparable() const;

 private:
  std::vector<std::int64_t> logger_minus_stamp_us_{};
  Timestamp first_stamp_{}, last_stamp_{}, first_logged_{}, last_logged_{};
};

/// Shifts poses onto the LiDAR's clock, with a note, if by the logger's times the clocks differ by
/// more than a second (no driver's delay is that long). Error of the shift: the difference of the
/// two drivers' delays.
/// @return the shift that was added to the stamps, else 0.
Duration put_on_clock(const ChannelClock& lidar, const ChannelClock& other, std::string_view name,
                      std::vector<ImportedPose>& poses, ImportReport& report);

/// The same for images.
Duration put_on_clock(const ChannelClock& lidar, const ChannelClock& camera,
                      std::vector<ImportedImage>& images, ImportReport& report);

}  // namespace waymark

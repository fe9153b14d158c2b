// SPDX-License-Identifier: BSD-3-Clause
// Messages of one log whose stamps are of different clocks.
#pragma once

#include "import/log/imported_log.hpp"

#include <string_view>
#include <vector>

namespace waymark {

/// How the stamps of a channel's messages run beside the logger's times.
class ChannelClock {
 public:
  void add(Timestamp stamp, Timestamp logged);

  bool empty() const { return logger_minus_stamp_us_.empty(); }

  /// Median: how far the logger's clock is ahead. @pre !empty()
  Duration logger_ahead() const;

  /// The logger's times advance as the stamps do, so that the two can be compared.
  bool is_comparable() const;

 private:
  std::vector<std::int64_t> logger_minus_stamp_us_{};
  Timestamp first_stamp_{}, last_stamp_{}, first_logged_{}, last_logged_{};
};

/// Shifts poses onto the LiDAR's clock when the logger's times say that the clocks are more than a
/// second apart (no driver is that late), and says so. The shift is as good as the difference of
/// the two drivers' delays.
void put_on_clock(const ChannelClock& lidar, const ChannelClock& other, std::string_view name,
                  std::vector<ImportedPose>& poses, ImportReport& report);

}  // namespace waymark

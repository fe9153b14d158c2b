// SPDX-License-Identifier: BSD-3-Clause
#include "import/mbot/clocks.hpp"

#include "common/geometry/median.hpp"
#include "common/messages/channels.hpp"
#include "common/messages/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <optional>

namespace waymark {
namespace {

constexpr Duration kSameClock = std::chrono::seconds{1};
constexpr std::int64_t kLatest_us = 4'000'000'000'000'000;  // year 2096: later stamps are garbage
constexpr double kComparable = 0.5;  // least ratio of a log's durations by the two clocks

/// Shift of the other channel's stamps, with a note; nullopt if none is needed.
std::optional<Duration> shift_of(const ChannelClock& lidar, const ChannelClock& other,
                                 std::string_view name, ImportReport& report) {
  if (lidar.empty() || other.empty() || !lidar.is_comparable() || !other.is_comparable())
    return std::nullopt;
  const Duration shift = other.logger_ahead() - lidar.logger_ahead();
  if (shift > -kSameClock && shift < kSameClock) return std::nullopt;
  report.note(fmt::format(
      "stamps of {} are of another clock than the LiDAR's, {:.3f} s apart by the logger's times: "
      "put onto the LiDAR's; only as exact as the logger",
      name, to_seconds(shift)));
  return shift;
}

}  // namespace

void ChannelClock::add(Timestamp stamp, Timestamp logged) {
  if (to_us(logged) < 0 || to_us(logged) > kLatest_us) return;
  if (empty()) {
    first_stamp_ = last_stamp_ = stamp;
    first_logged_ = last_logged_ = logged;
  }
  first_stamp_ = std::min(first_stamp_, stamp);
  last_stamp_ = std::max(last_stamp_, stamp);
  first_logged_ = std::min(first_logged_, logged);
  last_logged_ = std::max(last_logged_, logged);
  logger_minus_stamp_us_.push_back(to_us(logged) - to_us(stamp));
}

Duration ChannelClock::logger_ahead() const {
  return Duration{upper_median(logger_minus_stamp_us_)};
}

bool ChannelClock::is_comparable() const {
  const double by_stamps_s = to_seconds(last_stamp_ - first_stamp_);
  const double by_logger_s = to_seconds(last_logged_ - first_logged_);
  return by_logger_s > kComparable * by_stamps_s && by_stamps_s > kComparable * by_logger_s;
}

Duration put_on_clock(const ChannelClock& lidar, const ChannelClock& other, std::string_view name,
                      std::vector<ImportedPose>& poses, ImportReport& report) {
  const auto shift = shift_of(lidar, other, name, report);
  if (!shift) return Duration{0};
  // A stamp that would become negative is garbage: it stays, and is later removed as out of order.
  for (ImportedPose& pose : poses) {
    if (to_us(pose.time + *shift) >= 0) pose.time += *shift;
  }
  return *shift;
}

Duration put_on_clock(const ChannelClock& lidar, const ChannelClock& camera,
                      std::vector<ImportedImage>& images, ImportReport& report) {
  const auto shift = shift_of(lidar, camera, "images", report);
  if (!shift) return Duration{0};
  for (ImportedImage& image : images) {
    if (to_us(image.time + *shift) < 0) continue;
    image.time += *shift;
    image_t message = *decode<image_t>(image.message.payload).message;
    message.utime = to_us(image.time);
    image.message = encode(channels::kCamera, message);
  }
  return *shift;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Checks for damaged, missing or too large records of the log.
#include "common/messages/channels.hpp"
#include "doctor/checks.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kFewMissing = 0.01;
constexpr double kManyMissing = 0.1;
constexpr double kGap = 1.75;  // messages are missing in a gap longer than this [median intervals]
constexpr std::int64_t kDatagram_bytes = 65'000;  // largest message that fits one datagram
constexpr std::size_t kMinRecords = 10;
// A shorter silence at an end of the log is usual: sensors start and stop one after the other, and
// a LiDAR takes time to spin up.
constexpr double kUsualSilence_s = 3.0;

double percent(double share) {
  return 100.0 * share;
}

Verdict by_share(double share) {
  return share <= kFewMissing    ? Verdict::kPass
         : share <= kManyMissing ? Verdict::kWarn
                                 : Verdict::kFail;
}

/// Number of records that are missing in a silence at an end of the log.
double missing_in(double silence_s, double usual_s) {
  return silence_s > kUsualSilence_s ? std::round(silence_s / usual_s) : 0.0;
}

std::string silence_text(const Silence& silence) {
  std::string text;
  if (silence.at_start_s > kUsualSilence_s)
    text += fmt::format(", none in the first {:.1f} s", silence.at_start_s);
  if (silence.at_end_s > kUsualSilence_s)
    text += fmt::format(", none in the last {:.1f} s", silence.at_end_s);
  return text;
}

template <class Record>
Check check_drops(std::string name, std::string_view what, const std::vector<Record>& records,
                  const Silence& silence) {
  if (records.size() < kMinRecords) {
    return unchecked(std::move(name), fmt::format("{} {} are too few", records.size(), what),
                     "record a longer log");
  }
  std::vector<double> gaps_s;
  for (std::size_t i = 1; i < records.size(); ++i)
    gaps_s.push_back(to_seconds(records[i].time - records[i - 1].time));
  std::vector<double> sorted_s = gaps_s;
  std::ranges::sort(sorted_s);
  const double usual_s = sorted_s[sorted_s.size() / 2];
  double missing = missing_in(silence.at_start_s, usual_s) + missing_in(silence.at_end_s, usual_s);
  for (const double gap_s : gaps_s) {
    if (gap_s > kGap * usual_s) missing += std::round(gap_s / usual_s) - 1.0;
  }
  const double share = missing / (missing + static_cast<double>(records.size()));
  return {
      std::move(name), by_share(share),
      fmt::format("{:.1f} % of the {} are missing ({} are there, usually every {:.1f} ms, longest "
                  "gap {:.2f} s{})",
                  percent(share), what, records.size(), 1e3 * usual_s, sorted_s.back(),
                  silence_text(silence)),
      "look for a network or processor that is too slow, and for drivers that end or start anew",
      percent(share)};
}

}  // namespace

Check check_records(const DoctorInput& input) {
  const std::int64_t skipped = input.report.num_skipped();
  const auto used = static_cast<double>(input.log.scans.size() + input.log.odometry.size());
  const double share = static_cast<double>(skipped) / (used + static_cast<double>(skipped));
  std::string kinds;
  for (const auto& [kind, count] : input.report.skipped_by_kind())
    kinds += fmt::format(", {} {}", kind, count);
  return {"records",
          skipped == 0            ? Verdict::kPass
          : share <= kManyMissing ? Verdict::kWarn
                                  : Verdict::kFail,
          fmt::format("{} records cannot be used ({:.1f} %){}", skipped, percent(share), kinds),
          "waymark-import names each of them; record the log anew if it is damaged",
          static_cast<double>(skipped)};
}

Check check_lidar_drops(const DoctorInput& input) {
  return check_drops("lidar_drops", "scans", input.log.scans,
                     silence_of(input, input.lidar_channel));
}

Check check_odometry_drops(const DoctorInput& input) {
  return check_drops("odometry_drops", "odometry samples", input.log.odometry,
                     silence_of(input, input.odometry_channel));
}

Check check_camera_drops(const DoctorInput& input) {
  std::vector<ImportedPose> frames;  // only their times are used
  for (const Timestamp time : input.camera->times)
    frames.push_back({.time = time});
  std::ranges::sort(frames, {}, &ImportedPose::time);
  const auto& channel = input.camera->has_images ? channels::kCamera.name : channels::kMarkers.name;
  return check_drops("camera_drops", "camera frames", frames,
                     silence_of(input, std::string{channel}));
}

Check check_traffic(const DoctorInput& input) {
  if (input.channels.empty()) {
    return unchecked("traffic", "this is no LCM log", "record one with waymark-recorder");
  }
  const double seconds = std::max(1e-3, input.recorded_s);
  std::string text;
  double sum = 0.0;
  std::string too_large;
  for (const auto& [channel, traffic] : input.channels) {
    const double rate = static_cast<double>(traffic.bytes) / seconds;
    sum += rate;
    text += fmt::format("{}{} {:.1f} kB/s", text.empty() ? "" : ", ", channel, 1e-3 * rate);
    if (traffic.largest_bytes > kDatagram_bytes)
      too_large += fmt::format("{}{} has messages of {} bytes", too_large.empty() ? "" : ", ",
                               channel, traffic.largest_bytes);
  }
  if (!too_large.empty()) {
    return {"traffic", Verdict::kFail, too_large + fmt::format(", more than {}", kDatagram_bytes),
            "make images smaller, or compress them more: a message has to fit one datagram",
            1e-3 * sum};
  }
  return {"traffic", Verdict::kPass, fmt::format("{:.1f} kB/s: {}", 1e-3 * sum, text), "",
          1e-3 * sum};
}

}  // namespace waymark

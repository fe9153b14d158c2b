// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/imported_log.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "common/robot/described_sensors.hpp"
#include "import/log/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>

namespace waymark {
namespace {

constexpr Duration kLongestHold = std::chrono::seconds{1};
constexpr double kCommonShare = 0.05;   // a number of beams that so many scans have is intended
constexpr std::int64_t kMinCommon = 2;  // least number of such scans

/// Records per second, within what the configuration allows.
template <class Record>
double rate_hz(const std::vector<Record>& records, double low_hz, double high_hz) {
  if (records.size() < 2) return low_hz;
  const double seconds = to_seconds(records.back().time - records.front().time);
  return std::clamp(static_cast<double>(records.size() - 1) / seconds, low_hz, high_hz);
}

/// Removes repeated odometry without a report: it is redundant, but no error.
void remove_repeats(std::vector<ImportedPose>& poses) {
  const auto repeats = std::ranges::unique(poses, [](const auto& a, const auto& b) {
    return a.time == b.time && a.pose.translation() == b.pose.translation() &&
           a.pose.theta() == b.pose.theta();
  });
  poses.erase(repeats.begin(), repeats.end());
}

/// Pose at a time shortly before the first or after the last one: the motion of the adjacent second
/// extrapolated. Held if that second has too few samples for a speed.
Se2 extrapolated(const std::vector<ImportedPose>& poses, Timestamp time) {
  constexpr Duration kSpan = kLongestHold;
  const bool is_before = time < poses.front().time;
  const ImportedPose& end = is_before ? poses.front() : poses.back();
  const Timestamp beside = is_before ? end.time + kSpan : end.time - kSpan;
  const auto [first, last] = std::minmax(end.time, beside);
  const auto shown = std::ranges::count_if(poses, [&, low = first, high = last](const auto& pose) {
    return pose.time >= low && pose.time <= high;
  });
  if (shown < 3) return end.pose;
  const Se2 step = end.pose.inverse() * pose_at(poses, beside);
  const double share = to_seconds(time - end.time) / to_seconds(beside - end.time);
  return end.pose * Se2{share * step.translation(), share * step.theta()};
}

std::string held_or_extrapolated(const Se2& held, const Se2& pose, std::string_view which) {
  const bool is_held = held.translation() == pose.translation() && held.theta() == pose.theta();
  return fmt::format("{} {}", which, is_held ? "pose held" : "motion goes on");
}

/// When the scans and odometry were stamped, for a log in which no scan has odometry at its time.
std::string times_of(const std::vector<ImportedScan>& scans,
                     const std::vector<ImportedPose>& odometry) {
  constexpr double kDay_s = 86'400.0;
  const double first_s = to_seconds(odometry.front().time);
  const double last_s = to_seconds(odometry.back().time);
  const double first_scan_s = to_seconds(scans.front().time);
  const double last_scan_s = to_seconds(scans.back().last_beam_time);
  const double middles_apart_s = 0.5 * (first_s + last_s - first_scan_s - last_scan_s);
  const double apart_s = std::abs(middles_apart_s);
  return fmt::format(
      "the scans are stamped {:.3f} s to {:.3f} s, odometry {:.3f} s to {:.3f} s, about {:.1f} s{} "
      "{}: stamp both with one clock, when they are measured",
      first_scan_s, last_scan_s, first_s, last_s, apart_s,
      apart_s > kDay_s ? fmt::format(" ({:.1f} days)", apart_s / kDay_s) : "",
      middles_apart_s > 0.0 ? "later" : "earlier");
}

}  // namespace

LidarScan scan_of(const ImportedScan& scan) {
  const LidarConfig lidar{.mirrored = scan.is_mirrored, .late_s = to_seconds(scan.late)};
  if (fingerprint_of(scan.message.payload) == lidar_t::getHash()) {
    return as_described(to_scan(decode<lidar_t>(scan.message.payload).message.value()), lidar);
  }
  return as_described(to_scan(decode<planar_lidar_t>(scan.message.payload).message.value()), lidar);
}

void correct(ImportedScan& scan, bool is_mirrored, Duration late) {
  scan.is_mirrored = scan.is_mirrored != is_mirrored;
  scan.late += late;
  scan.time -= late;
  scan.last_beam_time -= late;
}

Se2 pose_at(const std::vector<ImportedPose>& poses, Timestamp time) {
  const auto after = std::ranges::lower_bound(poses, time, {}, &ImportedPose::time);
  if (after == poses.begin()) return after->pose;
  const auto before = std::prev(after);
  if (after == poses.end()) return before->pose;
  const double share = to_seconds(time - before->time) / to_seconds(after->time - before->time);
  const Se2 step = before->pose.inverse() * after->pose;
  return before->pose * Se2{share * step.translation(), share * step.theta()};
}

Se2 odometry_between(const ImportedLog& log, std::size_t first, std::size_t last) {
  return pose_at(log.odometry, log.scans[first].time).inverse() *
         pose_at(log.odometry, log.scans[last].time);
}

void keep_usual_beam_count(std::vector<ImportedScan>& scans, ImportReport& report) {
  std::map<int, std::int64_t> scans_by_count;
  for (const ImportedScan& scan : scans)
    ++scans_by_count[scan.num_beams];
  const auto usual =
      std::ranges::max_element(scans_by_count, {}, [](const auto& entry) { return entry.second; });
  const auto is_habit = [&](int num_beams) {
    const std::int64_t count = scans_by_count.at(num_beams);
    const double share = static_cast<double>(count) / static_cast<double>(scans.size());
    return count >= kMinCommon &&
           (share >= kCommonShare || std::abs(num_beams - usual->first) == 1);
  };
  std::string kept;
  std::set<int> rare;
  for (const auto& [num_beams, count] : scans_by_count) {
    if (!is_habit(num_beams) && num_beams != usual->first) {
      rare.insert(num_beams);
    } else {
      kept += fmt::format("{}{} (in {} scans)", kept.empty() ? "" : ", ", num_beams, count);
    }
  }
  if (scans_by_count.size() - rare.size() > 1)
    report.note("numbers of beams alternate, and all are kept: " + kept);
  const int usual_beams = usual->first;
  std::erase_if(scans, [&](const ImportedScan& scan) {
    if (!rare.contains(scan.num_beams)) return false;
    report.skip("changed beam count", scan.at,
                fmt::format("{} beams, but most scans have {}", scan.num_beams, usual_beams));
    return true;
  });
}

void cover_scans(ImportedLog& log, ImportReport& report) {
  if (log.odometry.empty() || log.scans.empty()) return;
  const Timestamp first = log.odometry.front().time;
  const Timestamp last = log.odometry.back().time;
  const auto is_outside = [&](Timestamp start, Timestamp end, std::int64_t at,
                              std::string_view what) {
    if (start >= first - kLongestHold && end <= last + kLongestHold) return false;
    report.skip("no odometry at its time", at,
                start < first ? fmt::format("{} at {:.6f} s, {:.3f} s before odometry", what,
                                            to_seconds(start), to_seconds(first - start))
                              : fmt::format("{} at {:.6f} s, {:.3f} s behind odometry", what,
                                            to_seconds(start), to_seconds(end - last)));
    return true;
  };
  std::erase_if(log.scans, [&](const ImportedScan& scan) {
    return is_outside(scan.time, scan.last_beam_time, scan.at, "a scan");
  });
  std::erase_if(log.images, [&](const ImportedImage& image) {
    return is_outside(image.time, image.time, image.at, "an image");
  });
  if (log.scans.empty()) return;
  const Timestamp first_scan = log.scans.front().time;
  const Timestamp last_scan = log.scans.back().last_beam_time;
  if (first_scan < first) {
    const Se2 pose = extrapolated(log.odometry, first_scan);
    log.odometry.insert(log.odometry.begin(), {first_scan, log.odometry.front().at, pose});
    report.note(fmt::format("odometry starts {:.3f} s after the first scan: {}",
                            to_seconds(first - first_scan),
                            held_or_extrapolated(log.odometry[1].pose, pose, "first")));
  }
  if (last_scan > last) {
    const Se2 pose = extrapolated(log.odometry, last_scan);
    log.odometry.push_back({last_scan, log.odometry.back().at, pose});
    report.note(fmt::format(
        "odometry ends {:.3f} s before the last scan: {}", to_seconds(last_scan - last),
        held_or_extrapolated(log.odometry[log.odometry.size() - 2].pose, pose, "last")));
  }
}

void make_consistent(ImportedLog& log, ImportReport& report) {
  restore_order(log.scans, "scan", report);
  keep_ascending(log.scans, "a scan", report);
  restore_order(log.odometry, "odometry sample", report);
  restore_order(log.reference, "reference pose", report);
  if (log.odometry.empty()) {
    for (const ImportedScan& scan : log.scans) {
      if (scan.odom_from_base) log.odometry.push_back({scan.time, scan.at, *scan.odom_from_base});
    }
  }
  remove_repeats(log.odometry);
  keep_ascending(log.odometry, "odometry", report);
  keep_ascending(log.reference, "a reference pose", report);
  const bool had_scans = !log.scans.empty();
  const std::string times =
      had_scans && !log.odometry.empty() ? times_of(log.scans, log.odometry) : "";
  cover_scans(log, report);
  const std::string held = log.contents.empty() ? "" : "; the log holds " + log.contents;
  if (!had_scans) throw SetupError{"no LiDAR scan could be read" + held};
  if (log.odometry.empty()) throw SetupError{"no odometry could be read" + held};
  if (log.scans.empty()) throw SetupError{"no scan has odometry at its time: " + times + held};
  log.robot.base.odometry_rate_hz = rate_hz(log.odometry, 1.0, 200.0);
  log.robot.lidar.rate_hz = rate_hz(log.scans, 0.1, 100.0);
  std::ranges::sort(log.images, {}, &ImportedImage::time);
  if (log.images.size() > 1) log.robot.camera.rate_hz = rate_hz(log.images, 0.1, 200.0);
  log.robot.lidar.num_beams = std::ranges::max(log.scans, {}, &ImportedScan::num_beams).num_beams;
}

void scale_distances(std::vector<ImportedPose>& odometry, double factor) {
  for (ImportedPose& sample : odometry)
    sample.pose = Se2{factor * sample.pose.translation(), sample.pose.theta()};
}

double path_length_m(const std::vector<ImportedPose>& poses) {
  double length_m = 0.0;
  for (std::size_t i = 1; i < poses.size(); ++i) {
    length_m += (poses[i].pose.translation() - poses[i - 1].pose.translation()).norm();
  }
  return length_m;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/odometry_breaks.hpp"

#include "common/geometry/median.hpp"
#include "common/time/clock_step_detector.hpp"
#include "common/time/date_text.hpp"
#include "import/findings/scan_overlay.hpp"
#include "import/log/time_order.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace waymark {
namespace {

// Limits beyond which a step of odometry is a jump: speed times time, plus a constant.
constexpr double kFastest_m_s = 5.0;
constexpr double kFastest_rad_s = 6.0;
constexpr double kJump_m = 0.5;
constexpr double kJump_rad = 0.5;

constexpr double kGapInPeriods = 10.0;
constexpr Duration kShortestGap = std::chrono::seconds{2};
constexpr double kSamePlace_m = 0.06;       // two scans with a smaller misfit are of one place
constexpr double kDifferentPlace_m = 0.15;  // scans with this misfit or more: different places
constexpr double kOften = 0.05;             // share of jumps above which odometry is not repaired
// In a bare corridor a scan fits anywhere along the corridor. A scan that fits where the robot was
// before a gap is evidence only if it does not fit 1 m away from there.
constexpr double kDistinct_m = 0.1;  // with a smaller misfit, places cannot be distinguished
const std::array<Eigen::Vector2d, 4> kAside_m{{{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}};

// The robot was moved in a gap of more than kLongGap if odometry stands still, but the scans before
// and behind differ: at least kMinChangedShare of the ranges in the same direction.
constexpr Duration kLongGap = std::chrono::seconds{5};
constexpr double kStood_m = 0.1;
constexpr double kStood_rad = 0.1;
constexpr double kMinRangeChange_m = 0.3;
constexpr double kMinChangedShare = 0.25;
constexpr std::size_t kMinSharedBearings = 60;
constexpr Duration kPauseStep = ClockStepDetector::kLongestPause / 2;

using Poses = std::vector<ImportedPose>;

Se2 step_of(const ImportedPose& before, const ImportedPose& now) {
  return before.pose.inverse() * now.pose;
}

bool is_jump(const ImportedPose& before, const ImportedPose& now) {
  const double elapsed_s = to_seconds(now.time - before.time);
  const Se2 step = step_of(before, now);
  return step.translation().norm() > kFastest_m_s * elapsed_s + kJump_m ||
         std::abs(step.theta()) > kFastest_rad_s * elapsed_s + kJump_rad;
}

bool is_zero(const ImportedPose& sample) {
  return sample.pose.translation() == Eigen::Vector2d::Zero() && sample.pose.theta() == 0.0;
}

/// The last scan up to a time, and the first one from a later time on; in order of angles.
struct ScansAround {
  LidarScan before{};
  LidarScan behind{};
};

/// True if at least kMinChangedShare of the beams differ; people who walk by change fewer.
bool are_of_other_places(const ScansAround& scans) {
  std::size_t others = 0;
  std::size_t shared = 0;
  auto behind = scans.behind.angles_rad.begin();
  for (std::size_t i = 0; i < scans.before.angles_rad.size(); ++i) {
    behind = std::lower_bound(behind, scans.behind.angles_rad.end(), scans.before.angles_rad[i]);
    if (behind == scans.behind.angles_rad.end()) break;
    if (*behind != scans.before.angles_rad[i]) continue;
    const double range_m =
        scans.behind.ranges_m[static_cast<std::size_t>(behind - scans.behind.angles_rad.begin())];
    ++shared;
    if (std::abs(range_m - scans.before.ranges_m[i]) > kMinRangeChange_m) ++others;
  }
  return shared >= kMinSharedBearings &&
         static_cast<double>(others) >= kMinChangedShare * static_cast<double>(shared);
}

std::optional<ScansAround> scans_around(const ImportedLog& log, Timestamp until, Timestamp from) {
  const auto after = std::ranges::upper_bound(log.scans, until, {}, &ImportedScan::time);
  const auto behind = std::ranges::lower_bound(log.scans, from, {}, &ImportedScan::time);
  if (after == log.scans.begin() || behind == log.scans.end()) return std::nullopt;
  return ScansAround{in_order_of_angles(scan_of(*std::prev(after))),
                     in_order_of_angles(scan_of(*behind))};
}

bool robot_stood(const ImportedLog& log, Timestamp until, Timestamp from) {
  const auto scans = scans_around(log, until, from);
  if (!scans) return false;
  const auto standing_m = misfit_m(scans->before, scans->behind, Se2{});
  return standing_m && *standing_m < kSamePlace_m;
}

void begin_where_odometry_begins(ImportedLog& log, ImportReport& report) {
  Poses& odometry = log.odometry;
  const auto first = std::ranges::find_if_not(odometry, is_zero);
  if (first == odometry.begin() || first == odometry.end() || !is_jump(*std::prev(first), *first))
    return;
  const Timestamp begin = first->time;
  const std::string found = fmt::format(
      "odometry is 0 for the first {:.1f} s and then begins {:.1f} m from there: the log was "
      "started "
      "before it",
      to_seconds(begin - odometry.front().time), first->pose.translation().norm());
  if (robot_stood(log, odometry.front().time, begin)) {
    for (auto sample = odometry.begin(); sample != first; ++sample)
      sample->pose = first->pose;
    report.note(found + "; the scans show that the robot stood: its first pose holds for them");
    return;
  }
  const auto is_before = [&](const auto& record) {
    return record.time < begin;
  };
  for (const ImportedScan& scan : log.scans)
    if (is_before(scan)) report.skip("before odometry", scan.at, "odometry is still 0");
  std::erase_if(log.scans, is_before);
  std::erase_if(log.images, is_before);
  odometry.erase(odometry.begin(), first);
  report.note(found + "; the robot moved meanwhile: the scans until then are left out");
}

void interpolate_single_jumps(Poses& odometry, ImportReport& report) {
  std::size_t count = 0;
  Timestamp first{};
  for (std::size_t i = 1; i + 1 < odometry.size(); ++i) {
    const ImportedPose& before = odometry[i - 1];
    const ImportedPose& behind = odometry[i + 1];
    if (!is_jump(before, odometry[i]) || !is_jump(odometry[i], behind) || is_jump(before, behind))
      continue;
    if (count++ == 0) first = odometry[i].time;
    odometry[i].pose = pose_at({before, behind}, odometry[i].time);
  }
  if (count == 0) return;
  report.note(
      fmt::format("odometry jumps away and back in {} single poses, first at {}: interpolated",
                  count, date_text(first)));
}

Duration usual_period(const Poses& odometry) {
  return odometry.size() < 2 ? kShortestGap : upper_median(periods_of(odometry));
}

/// Removes breaks of the odometry by accumulating the transform from raw to continuous poses.
class BreakRepairer {
 public:
  BreakRepairer(ImportedLog& log, ImportReport& report)
      : log_{log},
        report_{report},
        longest_{std::max(
            kShortestGap,
            Duration{static_cast<Duration::rep>(
                kGapInPeriods * static_cast<double>(usual_period(log.odometry).count()))})} {}

  void run() {
    const Poses raw = log_.odometry;
    Se2 repaired_from_raw{};
    for (std::size_t i = 1; i < raw.size(); ++i) {
      const Se2 before = i > 1 ? step_of(log_.odometry[i - 2], log_.odometry[i - 1]) : Se2{};
      if (const auto step = step_instead(raw[i - 1], raw[i], before))
        repaired_from_raw = log_.odometry[i - 1].pose * *step * raw[i].pose.inverse();
      log_.odometry[i].pose = repaired_from_raw * raw[i].pose;
    }
  }

 private:
  /// The robot's true step across a break of the odometry; nullopt if odometry's step is valid.
  std::optional<Se2> step_instead(const ImportedPose& before, const ImportedPose& now,
                                  const Se2& step_before) {
    const bool jumps = is_jump(before, now);
    const bool is_gap = now.time - before.time > longest_;
    if (!jumps && !is_gap) return std::nullopt;
    const auto scans = scans_around(log_, before.time, now.time);
    if (!scans) return std::nullopt;
    const Se2 base_from_lidar = log_.robot.lidar.base_from_lidar();
    const auto misfit_with = [&](const Se2& step) {
      return misfit_m(scans->before, scans->behind,
                      base_from_lidar.inverse() * step * base_from_lidar)
          .value_or(kDifferentPlace_m);
    };
    const Se2 step = step_of(before, now);
    const double counted_m = misfit_with(step);
    const double standing_m = misfit_with(Se2{});
    const double going_on_m = is_gap ? standing_m : misfit_with(step_before);
    const bool goes_on = going_on_m < standing_m;
    const auto is_only_place = [&] {
      return std::ranges::none_of(kAside_m, [&](const Eigen::Vector2d& aside) {
        return misfit_with({aside, 0.0}) < kDistinct_m;
      });
    };
    const bool is_reset = is_zero(now) && !is_zero(before);
    if (std::min(standing_m, going_on_m) < kSamePlace_m &&
        (jumps || is_reset || (counted_m >= kDifferentPlace_m && is_only_place()))) {
      name_new_beginning(now, step, goes_on);
      return goes_on ? step_before : Se2{};
    }
    const bool odometry_stood =
        step.translation().norm() < kStood_m && std::abs(step.theta()) < kStood_rad;
    if (now.time - before.time > kLongGap && odometry_stood && are_of_other_places(*scans))
      name_gap(before, now);
    return std::nullopt;
  }

  void name_new_beginning(const ImportedPose& now, const Se2& step, bool goes_on) {
    report_.note(fmt::format(
        "odometry begins anew at {}, {:.1f} m from where it was, while the scans show that the "
        "robot {}: it goes on where it was",
        date_text(now.time), step.translation().norm(), goes_on ? "drives on" : "stands"));
  }

  void name_gap(const ImportedPose& before, const ImportedPose& now) {
    report_.note(fmt::format(
        "a gap of {:.1f} s in the log at {}: odometry stands, but the scans before and behind the "
        "gap are of different places, so the robot was moved meanwhile; cut the log there, map "
        "both parts, and join the maps (waymark-map merge)",
        to_seconds(now.time - before.time), date_text(before.time)));
  }

  ImportedLog& log_;
  ImportReport& report_;
  Duration longest_;
};

/// True for odometry of another unit, or garbage, which cannot be repaired step by step.
bool jumps_often(const Poses& odometry) {
  std::size_t jumps = 0;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    jumps += is_jump(odometry[i - 1], odometry[i]) ? 1 : 0;
  return static_cast<double>(jumps) > kOften * static_cast<double>(odometry.size());
}

void bridge_long_pauses(Poses& odometry, ImportReport& report) {
  Poses bridged;
  std::size_t pauses = 0;
  Duration longest{0};
  Timestamp first{};
  for (const ImportedPose& sample : odometry) {
    if (!bridged.empty() && sample.time - bridged.back().time > kPauseStep) {
      const ImportedPose before = bridged.back();
      longest = std::max(longest, sample.time - before.time);
      if (pauses++ == 0) first = before.time;
      for (Timestamp time = before.time + kPauseStep; time < sample.time; time += kPauseStep)
        bridged.push_back({time, sample.at, pose_at({before, sample}, time)});
    }
    bridged.push_back(sample);
  }
  if (pauses == 0) return;
  odometry = std::move(bridged);
  report.note(
      fmt::format("{} pauses of more than {} min, first at {}, the longest of {:.1f} min: odometry "
                  "in between is "
                  "interpolated",
                  pauses, std::chrono::duration_cast<std::chrono::minutes>(kPauseStep).count(),
                  date_text(first), to_seconds(longest) / 60.0));
}

}  // namespace

void repair_odometry_breaks(ImportedLog& log, ImportReport& report) {
  if (!jumps_often(log.odometry)) {
    begin_where_odometry_begins(log, report);
    interpolate_single_jumps(log.odometry, report);
    BreakRepairer{log, report}.run();
  }
  bridge_long_pauses(log.odometry, report);
}

}  // namespace waymark

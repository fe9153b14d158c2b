// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/no_return.hpp"

#include "common/errors/setup_error.hpp"
#include "common/messages/codec.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>

namespace waymark {
namespace {

constexpr std::size_t kMaxScans = 3000;  // enough to find a code that 1 of 10,000 ranges has
constexpr double kOtherPlace_m = 0.1;
constexpr std::size_t kMinPlaces = 20;
constexpr double kFinest_m = 0.01;      // smallest width of a bin
constexpr double kStepQuantile = 0.05;  // this quantile of neighbours' differences is their step
// A bin is compared with the band of ranges that are up to this share shorter.
constexpr double kBandShare = 0.2;
constexpr double kTimesBand = 10.0;  // least count over the mean count in the band
constexpr double kNearShare = 0.05;  // a neighbour shorter by up to this share is slightly shorter
constexpr std::int64_t kMinCount = 20;     // ranges in the bin
constexpr std::int64_t kMinBeams = 10;     // different beams in the bin; a far wall is hit by fewer
constexpr double kMaxBeyond = 0.1;         // longer ranges / ranges in the bin
constexpr double kMaxNear = 0.2;           // share of neighbours that are slightly shorter
constexpr double kLongestLimit_m = 500.0;  // limit of robot.lidar.range_max_m
constexpr double kLongest_m = 1e4;         // longer ranges are garbage
constexpr double kRounding_m = 1e-4;       // rounding error of a float
constexpr float kNoReturn = std::numeric_limits<float>::infinity();
constexpr float kNotMeasured = std::numeric_limits<float>::quiet_NaN();

struct Bin {
  std::int64_t count{0};
  std::int64_t near{0};         ///< number of neighbours that are slightly shorter
  std::vector<bool> is_beam{};  ///< by index of the beam: true if it has had this range
  double smallest_m{kLongest_m};
};

bool is_range(double range_m) {
  return range_m > 0.0 && range_m < kLongest_m;
}

/// Bins as wide as the steps in which ranges are written: narrower ones would be empty in between.
double bin_width_m(std::span<const LidarScan> scans) {
  std::vector<double> differences_m;
  for (const LidarScan& scan : scans) {
    for (std::size_t i = 1; i < scan.ranges_m.size(); ++i) {
      const double difference_m = std::abs(scan.ranges_m[i] - scan.ranges_m[i - 1]);
      if (difference_m > kRounding_m && difference_m < kLongest_m)
        differences_m.push_back(difference_m);
    }
  }
  if (differences_m.empty()) return kFinest_m;
  const auto place =
      differences_m.begin() +
      static_cast<std::ptrdiff_t>(kStepQuantile * static_cast<double>(differences_m.size()));
  std::ranges::nth_element(differences_m, place);
  return std::max(kFinest_m, *place);
}

/// How often each range occurs, by bins.
class RangeHistogram {
 public:
  explicit RangeHistogram(std::span<const LidarScan> scans) : width_m_{bin_width_m(scans)} {
    for (const LidarScan& scan : scans) {
      for (std::size_t i = 0; i < scan.ranges_m.size(); ++i) {
        if (is_range(scan.ranges_m[i])) add(scan, i);
      }
    }
  }

  std::optional<NoReturnCode> code() const {
    NoReturnCode found;
    std::int64_t longer = 0;
    for (auto bin = bins_.rbegin(); bin != bins_.rend(); ++bin) {
      longer += bin->second.count;
      const std::int64_t beyond = longer - bin->second.count - found.count;
      if (is_at_most(beyond, kMaxBeyond, bin->second.count) && is_pile(bin->first)) {
        found.codes_m.insert(found.codes_m.begin(), bin->second.smallest_m);
        found.count = longer;
      }
    }
    return found.codes_m.empty() ? std::nullopt : std::optional{found};
  }

 private:
  static bool is_at_most(std::int64_t part, double share, std::int64_t whole) {
    return static_cast<double>(part) <= share * static_cast<double>(whole);
  }

  void add(const LidarScan& scan, std::size_t i) {
    const double range_m = scan.ranges_m[i];
    Bin& bin = bins_[std::llround(range_m / width_m_)];
    ++bin.count;
    if (bin.is_beam.size() <= i) bin.is_beam.resize(i + 1);
    bin.is_beam[i] = true;
    bin.smallest_m = std::min(bin.smallest_m, range_m);
    const auto is_near = [&](double other_m) {
      return other_m > (1.0 - kNearShare) * range_m && other_m < range_m - 0.5 * width_m_;
    };
    bin.near += i > 0 && is_near(scan.ranges_m[i - 1]);
    bin.near += i + 1 < scan.ranges_m.size() && is_near(scan.ranges_m[i + 1]);
  }

  bool is_pile(std::int64_t place) const {
    const Bin& bin = bins_.at(place);
    if (bin.count < kMinCount || !is_at_most(bin.near, kMaxNear, 2 * bin.count)) return false;
    if (std::ranges::count(bin.is_beam, true) < kMinBeams) return false;
    const auto low =
        static_cast<std::int64_t>(std::floor((1.0 - kBandShare) * static_cast<double>(place)));
    std::int64_t in_band = 0;
    for (auto other = bins_.lower_bound(low); other->first < place; ++other)
      in_band += other->second.count;
    const double mean = static_cast<double>(in_band) / static_cast<double>(place - low);
    return static_cast<double>(bin.count) >= kTimesBand * mean;
  }

  double width_m_;
  std::map<std::int64_t, Bin> bins_{};
};

/// Scans at least kOtherPlace_m apart; evenly spread ones if the robot hardly moves.
std::vector<LidarScan> scans_of_distinct_places(const ImportedLog& log) {
  std::vector<std::size_t> indices;
  Se2 last{};
  for (std::size_t i = 0; i < log.scans.size(); ++i) {
    const Se2 pose = pose_at(log.odometry, log.scans[i].time);
    if (!indices.empty() && (pose.translation() - last.translation()).norm() < kOtherPlace_m)
      continue;
    indices.push_back(i);
    last = pose;
  }
  if (indices.size() < kMinPlaces) {
    indices.resize(log.scans.size());
    std::iota(indices.begin(), indices.end(), std::size_t{0});
  }
  std::vector<LidarScan> scans;
  const std::size_t every = 1 + indices.size() / kMaxScans;
  for (std::size_t i = 0; i < indices.size(); i += every)
    scans.push_back(scan_of(log.scans[indices[i]]));
  return scans;
}

struct Counts {
  std::int64_t ranges{0};
  std::int64_t from_limit{0};
  std::int64_t zeros{0};
  std::int64_t removed{0};  ///< finite ranges at or above the limit
  std::int64_t left{0};     ///< measured ranges below the limit
};

template <class Type>
void mark(ImportedScan& scan, Channel<Type> channel, float limit_m, float no_return, float no_range,
          Counts& counts) {
  Type message = decode<Type>(scan.message.payload).message.value();
  bool has_changed = false;
  scan.longest_range_m = 0.0;
  for (float& range_m : message.ranges) {
    ++counts.ranges;
    counts.zeros += range_m == 0.0F;
    const bool is_beyond = range_m >= limit_m;
    counts.from_limit += is_beyond;
    counts.removed += is_beyond && std::isfinite(range_m);
    const float marked_m = is_beyond ? no_return : range_m == 0.0F ? no_range : range_m;
    has_changed |= marked_m != range_m;
    range_m = marked_m;
    if (!std::isfinite(range_m)) continue;
    counts.left += range_m > 0.0F;
    scan.longest_range_m = std::max(scan.longest_range_m, double{range_m});
  }
  if (has_changed) scan.message = encode(channel, message);
}

std::string text_of(const std::vector<double>& ranges_m) {
  std::string text;
  for (const double range_m : ranges_m)
    text += fmt::format("{}{:.2f}", text.empty() ? "" : ", ", range_m);
  return text;
}

double percent(std::int64_t part, std::int64_t whole) {
  return 100.0 * static_cast<double>(part) / static_cast<double>(std::max<std::int64_t>(1, whole));
}

/// @throws SetupError when no range is left.
void check_ranges_are_left(const Counts& counts, double limit_m) {
  if (counts.left > 0) return;
  if (counts.removed == 0) throw SetupError{"no beam of any scan has a range"};
  throw SetupError{fmt::format(
      "no range is left: {} of {} are {:.2f} m or longer, which counts as no return; if they are "
      "not metres give --range-unit (carmen), else --max-range-m",
      counts.removed, counts.ranges, limit_m)};
}

/// Rounded down to 0.1 mm, so that the same number as float is not below it.
double rounded_down(double range_m) {
  return std::floor(range_m * 1e4) / 1e4;
}

}  // namespace

std::optional<NoReturnCode> find_no_return_code(std::span<const LidarScan> scans) {
  return RangeHistogram{scans}.code();
}

void mark_no_returns(ImportedLog& log, const RangeLimit& limit, ImportReport& report) {
  const auto code =
      limit.given_m ? std::nullopt : find_no_return_code(scans_of_distinct_places(log));
  double limit_m = limit.given_m.value_or(limit.usual_m.value_or(double{kNoReturn}));
  if (code) limit_m = std::min(limit_m, rounded_down(code->codes_m.front()));
  const auto from_m = static_cast<float>(limit_m);
  Counts counts;
  bool is_rotating = false;
  for (ImportedScan& scan : log.scans) {
    is_rotating = fingerprint_of(scan.message.payload) == lidar_t::getHash();
    if (is_rotating) {
      const bool is_known = code || limit.given_m;
      mark(scan, channels::kMbotLidar, is_known ? from_m : kNoReturn, 0.0F, 0.0F, counts);
    } else {
      mark(scan, channels::kLidar, from_m, kNoReturn, kNotMeasured, counts);
    }
  }
  check_ranges_are_left(counts, limit_m);
  if (code) {
    log.no_return_codes_m = code->codes_m;
    report.note(fmt::format(
        "ranges pile up at {} m, and none is longer ({} of {}, {:.2f} %): taken for no return; "
        "--max-range-m says otherwise",
        text_of(code->codes_m), counts.from_limit, counts.ranges,
        percent(counts.from_limit, counts.ranges)));
  }
  if (counts.zeros > 0) {
    report.note(fmt::format("ranges of 0 m ({} of {}, {:.2f} %): taken for {}", counts.zeros,
                            counts.ranges, percent(counts.zeros, counts.ranges),
                            is_rotating ? "no return" : "not measured"));
  }
  if (std::isinf(limit_m)) {
    limit_m = std::ranges::max(log.scans, {}, &ImportedScan::longest_range_m).longest_range_m;
    report.note(
        fmt::format("no range says what is no return, and the longest is {:.2f} m: written as "
                    "the maximum; --max-range-m says otherwise",
                    limit_m));
  }
  log.robot.lidar.range_max_m = std::min(limit_m, kLongestLimit_m);
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/range_codes.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr double kBinsPerMetre = 100.0;
constexpr std::int64_t kCodesWithin_bins = 100;  // of the longest range
constexpr std::int64_t kNeighbours_bins = 3;     // the codes of a SICK are 4 cm apart
constexpr std::int64_t kFewest = 20;
constexpr double kTimesNeighbours = 20.0;

}  // namespace

void RangeHistogram::add(std::span<const double> ranges_m) {
  constexpr double kLongest_m = 1e6;
  for (const double range_m : ranges_m) {
    if (!(range_m > 0.0 && range_m < kLongest_m)) continue;
    Bin& bin = bins_[std::llround(range_m * kBinsPerMetre)];
    bin.smallest_m = bin.count == 0 ? range_m : std::min(bin.smallest_m, range_m);
    ++bin.count;
    ++total_;
  }
}

std::optional<RangeHistogram::Code> RangeHistogram::no_return_code() const {
  if (bins_.empty()) return std::nullopt;
  const auto count_at = [this](std::int64_t place) {
    const auto found = bins_.find(place);
    return found == bins_.end() ? std::int64_t{0} : found->second.count;
  };
  std::optional<Code> code;
  std::int64_t count = 0;
  for (auto bin = bins_.rbegin();
       bin != bins_.rend() && bin->first + kCodesWithin_bins >= bins_.rbegin()->first; ++bin) {
    count += bin->second.count;
    std::int64_t around = 0;
    for (std::int64_t i = 1; i <= kNeighbours_bins; ++i)
      around += count_at(bin->first - i) + count_at(bin->first + i);
    const double mean_around = static_cast<double>(around) / (2.0 * kNeighbours_bins);
    const bool is_code = bin->second.count >= kFewest &&
                         static_cast<double>(bin->second.count) >= kTimesNeighbours * mean_around;
    if (is_code) {
      code = Code{bin->second.smallest_m, count,
                  static_cast<double>(count) / static_cast<double>(total_)};
    }
  }
  return code;
}

}  // namespace waymark

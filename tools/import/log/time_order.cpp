// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/time_order.hpp"

#include <algorithm>

namespace waymark {

std::vector<std::size_t> order_within_tolerance(std::span<const Timestamp> times) {
  std::vector<std::size_t> order;
  for (std::size_t i = 0; i < times.size(); ++i) {
    auto place = order.end();
    while (place != order.begin() && times[i] < times[*std::prev(place)] &&
           times[*std::prev(place)] - times[i] <= kSmallDisorder)
      --place;
    order.insert(place, i);
  }
  return order;
}

std::vector<Timestamp> spread_over_gaps(std::span<const Timestamp> stamps) {
  constexpr Duration kSameStamp = std::chrono::milliseconds{1};
  constexpr Duration kLongestPeriod = std::chrono::seconds{1};
  constexpr Duration kLeast = std::chrono::microseconds{1};
  std::vector<Timestamp> spread;
  for (std::size_t first = 0; first < stamps.size();) {
    std::size_t end = first + 1;
    while (end < stamps.size() && stamps[end] <= stamps[first] &&
           stamps[first] - stamps[end] <= kSameStamp)
      ++end;
    const auto count = static_cast<Duration::rep>(end - first);
    const bool has_before = first > 0 && stamps[first] > stamps[first - 1];
    const bool has_after = end < stamps.size() && stamps[end] > stamps[first];
    const Duration before = has_before ? stamps[first] - spread.back() : Duration::zero();
    const Duration after = has_after ? stamps[end] - stamps[first] : Duration::zero();
    const bool has_stalled = has_before && (!has_after || before > 2 * after);
    const Duration period =
        std::clamp((has_stalled ? before : after) / count, kLeast, kLongestPeriod);
    for (Duration::rep i = 0; i < count; ++i) {
      const auto steps = has_stalled ? i + 1 - count : i;
      spread.push_back(count == 1 ? stamps[first] : stamps[first] + steps * period);
    }
    first = end;
  }
  return spread;
}

std::vector<bool> longest_ascending(std::span<const Timestamp> times) {
  // ends[k]: index of the smallest time that ends an ascending subsequence of length k + 1.
  std::vector<std::size_t> ends;
  std::vector<std::size_t> previous(times.size());
  for (std::size_t i = 0; i < times.size(); ++i) {
    const auto place = std::ranges::lower_bound(
        ends, times[i], {}, [times](std::size_t index) { return times[index]; });
    if (place != ends.begin()) previous[i] = *std::prev(place);
    if (place == ends.end()) {
      ends.push_back(i);
    } else {
      *place = i;
    }
  }
  std::vector<bool> keep(times.size(), false);
  std::size_t index = ends.empty() ? 0 : ends.back();
  for (std::size_t left = ends.size(); left > 0; --left) {
    keep[index] = true;
    index = previous[index];
  }
  return keep;
}

}  // namespace waymark

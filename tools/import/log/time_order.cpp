// SPDX-License-Identifier: BSD-3-Clause
#include "import/log/time_order.hpp"

#include <algorithm>

namespace waymark {

std::vector<std::size_t> settled_order(std::span<const Timestamp> times) {
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

// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <cstddef>
#include <iterator>
#include <vector>

namespace waymark {

/// Standard deviation divided by the median absolute deviation (MAD) of a normal distribution.
inline constexpr double kSigmaOfMad = 1.4826;

/// Median; of an even number of values the mean of the two middle ones. O(n log n).
/// @param values  not empty.
inline double median(std::vector<double> values) {
  std::ranges::sort(values);
  const std::size_t half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

/// Median; of an even number of values the larger of the two middle ones. O(n).
/// @param values  not empty.
template <class Value>
Value upper_median(std::vector<Value> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace waymark

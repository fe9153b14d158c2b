// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <algorithm>
#include <iterator>
#include <vector>

namespace waymark {

/// Median; of an even number of values the larger of the two middle ones. O(n).
/// @param values  not empty.
template <class Value>
Value upper_median(std::vector<Value> values) {
  const auto middle = values.begin() + std::ssize(values) / 2;
  std::ranges::nth_element(values, middle);
  return *middle;
}

}  // namespace waymark

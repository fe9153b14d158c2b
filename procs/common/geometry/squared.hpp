// SPDX-License-Identifier: BSD-3-Clause
#pragma once

namespace waymark {

constexpr double squared(double x) {
  return x * x;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// How the process counts what its core did not use.
#pragma once

#include "common/node/counters.hpp"
#include "slam/core/input/skip.hpp"

#include <string_view>

namespace waymark {

struct SkipCount {
  std::string_view name{};
  CountKind kind{CountKind::kEvent};
};

/// The counter of a reason.
SkipCount count_of(Skip skip);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// What a standard deviation that people give may be.
#pragma once

#include "common/config/fields.hpp"

namespace waymark {

/// [m] or [rad]: its variance, and the inverse of that, are numbers that can be reckoned with.
inline constexpr Range kSigmaRange{1e-6, 1e6};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Valid range of standard deviations in configurations and commands.
#pragma once

#include "common/config/fields.hpp"

namespace waymark {

/// [m] or [rad]: variance and information remain numerically tractable.
inline constexpr Range kSigmaRange{1e-6, 1e6};

}  // namespace waymark

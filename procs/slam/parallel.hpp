// SPDX-License-Identifier: BSD-3-Clause
// Threads for the core's loops.
#pragma once

#include "slam/core/filter/parallel_for.hpp"

namespace waymark {

/// Loops over particles with a number of threads of its own; 1 = in the caller's thread.
ParallelFor parallel_for_with(int threads);

}  // namespace waymark

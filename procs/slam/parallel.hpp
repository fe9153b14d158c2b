// SPDX-License-Identifier: BSD-3-Clause
// Threads for the core's parallel loops.
#pragma once

#include "slam/core/estimators/parallel_for.hpp"

namespace waymark {

/// A parallel loop with `threads` threads of its own; 1: in the caller's thread.
ParallelFor parallel_for_with(int threads);

}  // namespace waymark

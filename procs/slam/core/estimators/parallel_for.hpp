// SPDX-License-Identifier: BSD-3-Clause
// Parallel loop that a core gets from its caller, so that it does not depend on threads.
#pragma once

#include <cstddef>
#include <functional>

namespace waymark {

/// Calls body(0) ... body(count - 1), in any order and possibly concurrently, and returns when all
/// are done. Each call writes to memory of its own only, so the result does not depend on threads.
using ParallelFor =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// Calls the bodies one after the other.
inline void serial_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i)
    body(i);
}

}  // namespace waymark

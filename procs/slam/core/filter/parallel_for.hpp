// SPDX-License-Identifier: BSD-3-Clause
// How a core uses threads without knowing them: whoever calls it brings the loop.
#pragma once

#include <cstddef>
#include <functional>

namespace waymark {

/// Calls body(0) ... body(count - 1), in any order and perhaps at once, and returns when all are
/// done. Bodies write to places of their own only, so the result does not depend on the threads.
using ParallelFor =
    std::function<void(std::size_t count, const std::function<void(std::size_t)>& body)>;

/// One after the other.
inline void serial_for(std::size_t count, const std::function<void(std::size_t)>& body) {
  for (std::size_t i = 0; i < count; ++i)
    body(i);
}

}  // namespace waymark

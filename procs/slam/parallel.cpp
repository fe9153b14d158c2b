// SPDX-License-Identifier: BSD-3-Clause
#include "slam/parallel.hpp"

#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <memory>

namespace waymark {

ParallelFor parallel_for_with(int threads) {
  if (threads <= 1) return serial_for;
  auto arena = std::make_shared<tbb::task_arena>(threads);
  return [arena](std::size_t count, const std::function<void(std::size_t)>& body) {
    arena->execute([&] { tbb::parallel_for(std::size_t{0}, count, body); });
  };
}

}  // namespace waymark

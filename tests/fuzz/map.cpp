// SPDX-License-Identifier: BSD-3-Clause
// Input: a map file. It must be refused with a sentence, or loaded and then be writable.
#include "memory_file.hpp"
#include "slam/map_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const waymark::MapFile file = waymark::read_map_file(waymark::fuzz::memory_file({data, size}));
    waymark::to_map_messages(file.map, file.info);
  } catch (const waymark::SetupError&) {
  }
  return 0;
}

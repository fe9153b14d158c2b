// SPDX-License-Identifier: BSD-3-Clause
// Input: an LCM log. Every byte must belong to an event or count as skipped.
#include "common/log/log_file.hpp"
#include "memory_file.hpp"

#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  constexpr std::int64_t kHeader_bytes = 28;
  waymark::LogReader reader{waymark::fuzz::memory_file({data, size})};
  std::int64_t used_bytes = 0;
  while (const auto message = reader.next())
    used_bytes += kHeader_bytes + std::ssize(message->channel) + std::ssize(message->payload);
  if (used_bytes + reader.skipped_bytes() != static_cast<std::int64_t>(size)) std::abort();
  return 0;
}

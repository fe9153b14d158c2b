// SPDX-License-Identifier: BSD-3-Clause
// Prints what the C++ reader finds in logs, for comparison with the Python reader: for each log the
// number of events, a hash of their contents, and the skipped bytes.
//
// usage: list_events LOG...
#include "common/log/log_file.hpp"

#include <cstdint>
#include <cstdio>

int main(int argc, char** argv) {
  constexpr std::uint32_t kOffsetBasis = 2166136261U;  // FNV-1a, 32 bit
  constexpr std::uint32_t kPrime = 16777619U;
  for (int i = 1; i < argc; ++i) {
    waymark::LogReader reader{argv[i]};
    int events = 0;
    std::uint32_t hash = kOffsetBasis;
    const auto mix = [&hash](std::uint8_t byte) {
      hash = (hash ^ byte) * kPrime;
    };
    while (const auto event = reader.next()) {
      ++events;
      for (const char c : event->channel)
        mix(static_cast<std::uint8_t>(c));
      for (const std::uint8_t byte : event->payload)
        mix(byte);
      for (int shift = 0; shift < 64; shift += 8)
        mix(static_cast<std::uint8_t>(waymark::to_us(event->time) >> shift));
    }
    std::printf("%d %u %lld %lld\n", events, hash, static_cast<long long>(reader.skipped_bytes()),
                static_cast<long long>(reader.first_skipped_offset()));
  }
}

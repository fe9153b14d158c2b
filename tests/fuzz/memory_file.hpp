// SPDX-License-Identifier: BSD-3-Clause
// A file in memory, for code that reads files.
#pragma once

#include <sys/mman.h>
#include <unistd.h>

#include <cstdint>
#include <filesystem>
#include <span>
#include <stdexcept>
#include <string>

namespace waymark::fuzz {

/// Path of a file with these bytes; valid until the next call.
inline std::filesystem::path memory_file(std::span<const std::uint8_t> bytes) {
  static const int file = memfd_create("fuzz", MFD_CLOEXEC);
  const auto size = static_cast<off_t>(bytes.size());
  if (file < 0 || ftruncate(file, size) != 0 || pwrite(file, bytes.data(), bytes.size(), 0) != size)
    throw std::runtime_error{"no file in memory"};
  return "/proc/self/fd/" + std::to_string(file);
}

}  // namespace waymark::fuzz

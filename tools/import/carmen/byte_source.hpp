// SPDX-License-Identifier: BSD-3-Clause
// The bytes of a file, compressed with gzip or bzip2 or not at all.
#pragma once

#include <filesystem>
#include <memory>
#include <span>
#include <string>

namespace waymark {

class ByteSource {
 public:
  virtual ~ByteSource() = default;

  /// Number of bytes put into the buffer; 0 at the end of what can be read.
  virtual std::size_t read(std::span<char> buffer) = 0;

  /// Why the file ended before its end (cut off or damaged compressed data); empty when it did not.
  virtual std::string fault() const = 0;
};

/// By the file's first bytes, whatever its name.
/// @throws SetupError when the file cannot be read or is empty.
std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path);

}  // namespace waymark

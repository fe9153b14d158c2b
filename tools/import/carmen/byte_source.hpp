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

  /// @return number of bytes read into the buffer; 0 at the end of the readable part.
  virtual std::size_t read(std::span<char> buffer) = 0;

  /// Why reading stopped early (truncated or damaged compressed data); empty if it did not.
  virtual std::string fault() const = 0;
};

/// Recognises the format by the file's first bytes, not by its name.
/// @throws SetupError when the file cannot be read or is empty.
std::unique_ptr<ByteSource> open_bytes(const std::filesystem::path& path);

}  // namespace waymark

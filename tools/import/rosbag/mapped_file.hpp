// SPDX-License-Identifier: BSD-3-Clause
// A file mapped into memory (mmap), read-only.
#pragma once

#include "import/rosbag/byte_cursor.hpp"

#include <filesystem>

namespace waymark {

class MappedFile {
 public:
  /// @throws SetupError when the file cannot be read.
  explicit MappedFile(const std::filesystem::path& file);
  ~MappedFile();
  MappedFile(const MappedFile&) = delete;
  MappedFile& operator=(const MappedFile&) = delete;

  ByteView bytes() const { return bytes_; }

 private:
  ByteView bytes_{};
};

}  // namespace waymark

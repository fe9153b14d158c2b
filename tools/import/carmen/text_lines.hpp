// SPDX-License-Identifier: BSD-3-Clause
// The lines of a text file, compressed with gzip or bzip2 or not.
#pragma once

#include "import/carmen/byte_source.hpp"

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark {

class TextLines {
 public:
  /// @throws SetupError when the file cannot be read or is empty.
  explicit TextLines(const std::filesystem::path& path);

  /// Next line without its end; valid until the next call. Lines are cut to 1 MiB. nullopt at the
  /// end.
  std::optional<std::string_view> next();

  /// Number of the last line that next() returned, from 1.
  std::int64_t line_number() const { return line_number_; }

  /// Why reading stopped early (truncated or damaged compressed data); empty if it did not.
  std::string fault() const { return bytes_->fault(); }

 private:
  bool fill();

  std::unique_ptr<ByteSource> bytes_;
  std::vector<char> buffer_;
  std::string_view unread_{};  ///< part of buffer_
  std::string line_{};
  std::int64_t line_number_{0};
};

}  // namespace waymark

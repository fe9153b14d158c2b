// SPDX-License-Identifier: BSD-3-Clause
#include "common/files/whole_file.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <system_error>
#include <utility>

namespace waymark {
namespace {

/// Closes and removes the temporary file unless it was renamed.
class TemporaryFile {
 public:
  explicit TemporaryFile(std::filesystem::path path)
      : path_{std::move(path)}, file_{std::fopen(path_.c_str(), "wb")} {}

  TemporaryFile(const TemporaryFile&) = delete;
  TemporaryFile& operator=(const TemporaryFile&) = delete;

  ~TemporaryFile() {
    const bool was_opened = file_ != nullptr || is_closed_;
    if (file_ != nullptr) std::fclose(file_);
    if (was_opened && !is_renamed_) std::remove(path_.c_str());
  }

  bool write(std::string_view bytes) {
    if (file_ == nullptr) return false;
    if (std::fwrite(bytes.data(), 1, bytes.size(), file_) != bytes.size()) return false;
    is_closed_ = true;  // also when closing fails: that is when a full disk may show
    return std::fclose(std::exchange(file_, nullptr)) == 0;
  }

  bool rename_to(const std::filesystem::path& file) {
    is_renamed_ = std::rename(path_.c_str(), file.c_str()) == 0;
    return is_renamed_;
  }

 private:
  std::filesystem::path path_;
  std::FILE* file_;
  bool is_closed_{false};
  bool is_renamed_{false};
};

}  // namespace

void write_whole_file(const std::filesystem::path& file, std::string_view bytes) {
  TemporaryFile temporary{file.parent_path() / fmt::format(".{}.part", file.filename().string())};
  if (!temporary.write(bytes) || !temporary.rename_to(file)) {
    throw std::system_error{errno, std::generic_category(), file.string() + ": cannot be written"};
  }
}

std::string read_whole_file(const std::filesystem::path& file) {
  std::ifstream stream{file, std::ios::binary};
  std::string bytes{std::istreambuf_iterator<char>{stream}, {}};
  if (!stream) {
    throw std::system_error{errno, std::generic_category(), file.string() + ": cannot be read"};
  }
  return bytes;
}

}  // namespace waymark

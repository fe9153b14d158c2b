// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/output_folder.hpp"

#include "common/process/node.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <cerrno>
#include <cstdio>
#include <system_error>

namespace waymark::viewer {
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

void write_file_atomically(const std::filesystem::path& file, std::string_view bytes) {
  TemporaryFile temporary{file.parent_path() / fmt::format(".{}.part", file.filename().string())};
  if (!temporary.write(bytes) || !temporary.rename_to(file)) {
    throw std::system_error{errno, std::generic_category(), file.string() + ": cannot be written"};
  }
}

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_{std::move(folder)} {
  const std::filesystem::path probe = folder_ / ".writable";
  try {
    std::filesystem::create_directories(folder_);
    write_file_atomically(probe, "");
    std::filesystem::remove(probe);
  } catch (const std::system_error& error) {
    throw SetupError{
        fmt::format("--out {}: files cannot be written there ({}); give a folder that you may "
                    "write to",
                    folder_.string(), error.code().message())};
  }
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
  try {
    write_file_atomically(folder_ / name, bytes);
  } catch (const std::system_error& error) {
    spdlog::error("{}", error.what());
    failed_files_.insert(name);
  }
}

void OutputFolder::remove(const std::string& name) {
  std::error_code error;
  std::filesystem::remove(folder_ / name, error);
  if (!error) return;
  spdlog::error("{}: cannot be removed", (folder_ / name).string());
  failed_files_.insert(name);
}

}  // namespace waymark::viewer

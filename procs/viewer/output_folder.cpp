// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/output_folder.hpp"

#include "common/files/whole_file.hpp"
#include "common/process/node.hpp"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <system_error>

namespace waymark::viewer {

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_{std::move(folder)} {
  const std::filesystem::path probe = folder_ / ".writable";
  try {
    std::filesystem::create_directories(folder_);
    write_whole_file(probe, "");
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
    write_whole_file(folder_ / name, bytes);
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

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/output_folder.hpp"

#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/logging/logging.hpp"

#include <system_error>
#include <utility>

namespace waymark::viewer {

OutputFolder::OutputFolder(std::filesystem::path folder) : folder_{std::move(folder)} {
  make_writable_folder(folder_);
}

void OutputFolder::write(const std::string& name, std::string_view bytes) {
  try {
    write_whole_file(folder_ / name, bytes);
  } catch (const std::system_error& error) {
    logging::error("{}", error.what());
    failed_files_.insert(name);
  }
}

void OutputFolder::remove(const std::string& name) {
  std::error_code error;
  std::filesystem::remove(folder_ / name, error);
  if (!error) return;
  logging::error("{}: cannot be removed", (folder_ / name).string());
  failed_files_.insert(name);
}

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "common/files/writable_folder.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"

#include <fmt/format.h>

#include <system_error>

namespace waymark {

void make_writable_folder(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / ".writable";
  try {
    std::filesystem::create_directories(folder);
    write_whole_file(probe, "");
    std::filesystem::remove(probe);
  } catch (const std::system_error& error) {
    throw SetupError{
        fmt::format("{}: files cannot be written there ({}); give a folder that you may write to",
                    folder.string(), error.code().message())};
  }
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/files/writable_folder.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cerrno>
#include <system_error>

namespace waymark {
namespace {

SetupError not_writable(const std::filesystem::path& folder, const std::error_code& why) {
  return SetupError{
      fmt::format("{}: files cannot be written there ({}); give a folder that you may write to",
                  folder.string(), why.message())};
}

}  // namespace

void make_writable_folder(const std::filesystem::path& folder) {
  const std::filesystem::path probe = folder / ".writable";
  try {
    std::filesystem::create_directories(folder);
    write_whole_file(probe, "");
    std::filesystem::remove(probe);
  } catch (const std::system_error& error) {
    throw not_writable(folder, error.code());
  }
}

void check_writable_folder(const std::filesystem::path& folder) {
  // The first folder above that exists is the one in which the others would be made.
  std::filesystem::path existing = std::filesystem::absolute(folder).lexically_normal();
  std::error_code error;
  while (!std::filesystem::exists(existing, error) && existing != existing.root_path())
    existing = existing.parent_path();
  if (!std::filesystem::is_directory(existing, error))
    throw not_writable(folder, std::make_error_code(std::errc::not_a_directory));
  if (::access(existing.c_str(), W_OK | X_OK) != 0)
    throw not_writable(folder, std::error_code{errno, std::generic_category()});
}

void check_output_file(std::string_view option, const std::filesystem::path& file) {
  const std::filesystem::path folder = file.has_parent_path() ? file.parent_path() : ".";
  std::error_code error;
  if (!std::filesystem::is_directory(folder, error) && error != std::errc::permission_denied)
    throw SetupError{fmt::format("{}: there is no folder '{}'", option, folder.string())};
  if (std::filesystem::is_directory(file, error))
    throw SetupError{fmt::format("{}: '{}' is a folder", option, file.string())};
  if (::access(folder.c_str(), W_OK) != 0)
    throw SetupError{fmt::format("{}: cannot write to the folder '{}'", option, folder.string())};
}

}  // namespace waymark

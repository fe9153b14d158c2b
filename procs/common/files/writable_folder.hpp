// SPDX-License-Identifier: BSD-3-Clause
// Output folders and files, checked before the work begins.
#pragma once

#include <filesystem>
#include <string_view>

namespace waymark {

/// Creates the folder if it does not exist, and checks by a temporary file that it is writable.
/// @throws SetupError when it cannot be created or written to.
void make_writable_folder(const std::filesystem::path& folder);

/// Checks, without writing anything, that make_writable_folder() would succeed.
/// @throws SetupError
void check_writable_folder(const std::filesystem::path& folder);

/// Checks, without writing anything, that a file can be written under that name: the folder is
/// there and may be written to, and the name is no folder's.
/// @param option  the command-line option that gave the name, for the error message.
/// @throws SetupError
void check_output_file(std::string_view option, const std::filesystem::path& file);

}  // namespace waymark

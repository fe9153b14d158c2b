// SPDX-License-Identifier: BSD-3-Clause
// Files that are written atomically.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

namespace waymark {

/// Writes to a temporary name in the same folder and renames it, so that a reader finds the old
/// content or the new, never a part.
/// @throws std::system_error with the file's name; the old file then still stands.
void write_whole_file(const std::filesystem::path& file, std::string_view bytes);

/// @return the file's content.
/// @throws std::system_error with the file's name.
std::string read_whole_file(const std::filesystem::path& file);

}  // namespace waymark

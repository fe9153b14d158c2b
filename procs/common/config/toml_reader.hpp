// SPDX-License-Identifier: BSD-3-Clause
// Reads one TOML source into a described struct (see Fields). The only code that includes toml++.
#pragma once

#include "common/config/config.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace waymark::config_detail {

enum class UnknownKeys {
  kProblem,
  kIgnored  ///< the file may have keys that the struct does not describe
};

/// Result of reading several sources.
struct ReadLog {
  std::vector<std::string> problems{};  ///< one line each
  Locations set_by{};                   ///< key -> the last source that set it, with line
};

/// Sets the fields of the described struct that the file has.
void read_toml_file(const std::filesystem::path& file, const std::function<void(Fields&)>& describe,
                    ReadLog& log, UnknownKeys unknown_keys = UnknownKeys::kProblem);

/// The same for the text of a file.
/// @param name  of the file, for messages.
void read_toml_text(const std::string& text, const std::string& name,
                    const std::function<void(Fields&)>& describe, ReadLog& log,
                    UnknownKeys unknown_keys = UnknownKeys::kProblem);

/// Sets the field that one `key.subkey=value` of the command line names.
void read_toml_override(const std::string& text, const std::function<void(Fields&)>& describe,
                        ReadLog& log);

}  // namespace waymark::config_detail

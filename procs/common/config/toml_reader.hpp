// SPDX-License-Identifier: BSD-3-Clause
// One TOML source -> one described struct. The only code that includes toml++.
#pragma once

#include "common/config/config.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <vector>

namespace waymark::config_detail {

enum class UnknownKeys {
  kProblem,
  kIgnored  ///< the file holds more than the struct describes
};

/// Result of reading several sources.
struct ReadLog {
  std::vector<std::string> problems{};  ///< one line each
  Locations set_by{};                   ///< key -> the last source that set it, with line
};

/// Overlays the described struct with a file.
void read_toml_file(const std::filesystem::path& file, const std::function<void(Fields&)>& describe,
                    ReadLog& log, UnknownKeys unknown_keys = UnknownKeys::kProblem);

/// The same for one `key.subkey=value` of the command line.
void read_toml_override(const std::string& text, const std::function<void(Fields&)>& describe,
                        ReadLog& log);

/// The candidate nearest to a misspelt `key`; empty if none is near.
std::string nearest(const std::string& key, const std::vector<std::string>& candidates);

}  // namespace waymark::config_detail

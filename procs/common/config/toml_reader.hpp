// SPDX-License-Identifier: BSD-3-Clause
// One TOML source -> one described struct. The only code that includes toml++.
#pragma once

#include "common/config/fields.hpp"

#include <filesystem>
#include <functional>
#include <string>
#include <vector>

namespace waymark::config_detail {

enum class UnknownKeys {
  kProblem,
  kIgnored  ///< the file holds more than the struct describes
};

/// Overlays the described struct with a file; appends one line per problem.
void read_toml_file(const std::filesystem::path& file, const std::function<void(Fields&)>& describe,
                    std::vector<std::string>& problems,
                    UnknownKeys unknown_keys = UnknownKeys::kProblem);

/// The same for one `key.subkey=value` of the command line.
void read_toml_override(const std::string& text, const std::function<void(Fields&)>& describe,
                        std::vector<std::string>& problems);

}  // namespace waymark::config_detail

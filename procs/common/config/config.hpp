// SPDX-License-Identifier: BSD-3-Clause
// Reading configuration structs from TOML files and the command line, and writing them.
#pragma once

#include "common/config/fields.hpp"
#include "common/errors/setup_error.hpp"

#include <filesystem>
#include <functional>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace waymark {

/// All problems of a configuration; what() has one line per problem: `where: key: got X, expected
/// Y`.
class ConfigError : public SetupError {
 public:
  explicit ConfigError(const std::vector<std::string>& problems);
};

/// Where a configuration comes from: files win over texts, later files over earlier ones, overrides
/// over all files, and all of them over the defaults.
struct ConfigSources {
  std::vector<std::filesystem::path> files{};
  std::vector<std::string> overrides{};  ///< "key.subkey=value", value as in TOML or a bare word
  std::map<std::string, std::string> texts{};  ///< TOML, by the file's name for messages
};

namespace config_detail {
/// Where each key was set last, e.g. "robot.lidar.rate_hz" -> "robot.toml:7".
using Locations = std::map<std::string, std::string, std::less<>>;
}  // namespace config_detail

/// Problems found by a struct's `check(Problems&)`: what the range of a single field cannot
/// express.
class Problems {
 public:
  Problems() = default;

  explicit Problems(config_detail::Locations locations) : locations_{std::move(locations)} {}

  /// @param key  e.g. "robot.lidar.range_min_m"; the line begins with the source that set the key.
  void add(const std::string& key, const std::string& problem);

  const std::vector<std::string>& lines() const { return lines_; }

 private:
  config_detail::Locations locations_{};
  std::vector<std::string> lines_{};
};

namespace config_detail {
using Describe = std::function<void(Fields&)>;
/// Reads all sources into the described struct; returns all problems, and where keys were set.
std::vector<std::string> read(const ConfigSources& sources, const Describe& describe,
                              Locations& locations);
/// Reads one file, of which the struct describes only a part.
std::vector<std::string> read_part(const std::filesystem::path& file, const Describe& describe);
std::string dump(const Describe& describe);
std::string value(const Describe& describe, const std::string& key);
}  // namespace config_detail

/// The struct's defaults, overlaid by the sources, checked.
/// @throws ConfigError with all problems: unreadable files, syntax, unknown keys (with the nearest
/// known one), keys that the other settings do not use, types, ranges; if there are none of these,
/// what the struct's own check() finds.
template <class Config>
Config load_config(const ConfigSources& sources) {
  Config config{};
  config_detail::Locations locations;
  auto problems = config_detail::read(
      sources, [&config](Fields& fields) { config.describe(fields); }, locations);
  if (problems.empty()) {
    if constexpr (requires(Problems & p) { config.check(p); }) {
      Problems found{std::move(locations)};
      config.check(found);
      problems = found.lines();
    }
  }
  if (!problems.empty()) throw ConfigError{problems};
  return config;
}

/// The struct's defaults, overlaid by the keys of a file that the struct describes; other keys are
/// ignored, and the struct's check() is not called.
/// @throws ConfigError for an unreadable file, syntax, types and ranges.
template <class Config>
Config load_part(const std::filesystem::path& file) {
  Config config{};
  const auto problems =
      config_detail::read_part(file, [&config](Fields& fields) { config.describe(fields); });
  if (!problems.empty()) throw ConfigError{problems};
  return config;
}

/// The effective configuration as TOML: each used key with its meaning as a comment. Reading the
/// text back gives the same values.
template <class Config>
std::string dump_config(const Config& config) {
  Config copy = config;
  return config_detail::dump([&copy](Fields& fields) { copy.describe(fields); });
}

/// One value of the effective configuration as TOML, strings bare.
/// @param key  as in messages, e.g. "slam.estimator".
/// @throws ConfigError if there is no such key, or nothing uses it.
template <class Config>
std::string config_value(const Config& config, const std::string& key) {
  Config copy = config;
  return config_detail::value([&copy](Fields& fields) { copy.describe(fields); }, key);
}

}  // namespace waymark

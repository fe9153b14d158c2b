// SPDX-License-Identifier: BSD-3-Clause
#include "common/config/config.hpp"

#include "common/config/nearest_key.hpp"
#include "common/config/toml_reader.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

std::string join_lines(const std::vector<std::string>& lines) {
  std::string text;
  for (const std::string& line : lines)
    text += (text.empty() ? "" : "\n") + line;
  return text;
}

/// Shortest text that reads back as the same double, and that TOML takes for a float.
std::string float_text(double value) {
  if (std::isnan(value)) return "nan";
  if (std::isinf(value)) return value > 0 ? "inf" : "-inf";
  std::string text = fmt::format("{}", value);
  if (text.find_first_of(".e") == std::string::npos) text += ".0";
  return text;
}

std::string toml_string(const std::string& value) {
  std::string text = "\"";
  for (const char c : value) {
    if (c == '"' || c == '\\') text += '\\';
    if (static_cast<unsigned char>(c) < 0x20 || c == 0x7f) {
      text += fmt::format("\\u{:04X}", static_cast<int>(c));
    } else {
      text += c;
    }
  }
  return text + '"';
}

/// A line of a described configuration.
struct Entry {
  enum class Kind { kTable, kElement, kValue, kEmptyList };

  Kind kind{Kind::kValue};
  std::string table{};    ///< the table that the line begins or belongs to: "path.waypoints[0]."
  std::string key{};      ///< "slam.estimator", "path.waypoints[0].x_m"
  std::string heading{};  ///< of a table or element, e.g. "path.waypoints"
  std::string value{};    ///< as TOML
  std::string text{};     ///< the value, strings without quotes
  std::string meaning{};
  std::string unused{};  ///< why the key is unused; empty = it is used
};

/// Lists all that a configuration describes, in file order.
class Lister final : public Fields {
 public:
  using Fields::field;

  void field(std::string_view key, bool& value, std::string_view meaning) override {
    add(key, value ? "true" : "false", meaning);
  }

  void field(std::string_view key, std::string& value, std::string_view meaning) override {
    add(key, toml_string(value), meaning);
    entries_.back().text = value;
  }

  void field(std::string_view key, int& value, Range, std::string_view meaning) override {
    add(key, fmt::format("{}", value), meaning);
  }

  void field(std::string_view key, std::int64_t& value, Range, std::string_view meaning) override {
    add(key, fmt::format("{}", value), meaning);
  }

  void field(std::string_view key, double& value, Range, std::string_view meaning) override {
    add(key, float_text(value), meaning);
  }

  void field(std::string_view key, std::vector<int>& value, Range,
             std::string_view meaning) override {
    add(key, fmt::format("[{}]", fmt::join(value, ", ")), meaning);
  }

  void field(std::string_view key, std::vector<double>& value, Range,
             std::string_view meaning) override {
    std::vector<std::string> texts;
    for (const double v : value)
      texts.push_back(float_text(v));
    add(key, fmt::format("[{}]", fmt::join(texts, ", ")), meaning);
  }

  void field(std::string_view key, std::vector<std::string>& value,
             std::string_view meaning) override {
    std::vector<std::string> texts;
    for (const std::string& v : value)
      texts.push_back(toml_string(v));
    add(key, fmt::format("[{}]", fmt::join(texts, ", ")), meaning);
  }

  const std::vector<Entry>& entries() const { return entries_; }

 protected:
  void word(std::string_view key, std::span<const std::string_view> words, std::size_t& index,
            std::string_view meaning) override {
    add(key, toml_string(std::string{words[index]}),
        fmt::format("{} ({})", meaning, fmt::join(words, " | ")));
    entries_.back().text = words[index];
  }

  bool enter(std::string_view key) override {
    tables_.push_back({std::string{key}, std::string{key}});
    entries_.push_back(
        {.kind = Entry::Kind::kTable, .table = path(), .heading = heading(), .unused = unused()});
    return true;
  }

  bool enter_element(std::string_view key, std::size_t index) override {
    tables_.push_back({std::string{key}, fmt::format("{}[{}]", key, index)});
    entries_.push_back(
        {.kind = Entry::Kind::kElement, .table = path(), .heading = heading(), .unused = unused()});
    return true;
  }

  void leave() override { tables_.pop_back(); }

  bool enter_use(bool is_used, std::string_view unused) override {
    unused_.emplace_back(is_used ? "" : unused);
    return true;
  }

  void leave_use() override { unused_.pop_back(); }

  std::optional<std::size_t> list_size(std::string_view key, std::size_t current_size,
                                       std::string_view meaning) override {
    if (current_size == 0) {
      entries_.push_back({.kind = Entry::Kind::kEmptyList,
                          .heading = std::string{key},
                          .meaning = std::string{meaning},
                          .unused = unused()});
    }
    return std::nullopt;
  }

 private:
  struct Table {
    std::string name;     ///< in a heading: "path.waypoints"
    std::string element;  ///< in a key: "path.waypoints[0]"
  };

  void add(std::string_view key, const std::string& value, std::string_view meaning) {
    entries_.push_back({.table = path(),
                        .key = path() + std::string{key},
                        .value = value,
                        .text = value,
                        .meaning = std::string{meaning},
                        .unused = unused()});
  }

  std::string path() const {
    std::string text;
    for (const Table& table : tables_)
      text += table.element + ".";
    return text;
  }

  std::string heading() const {
    std::string text;
    for (const Table& table : tables_)
      text += (text.empty() ? "" : ".") + table.name;
    return text;
  }

  std::string unused() const {
    for (const std::string& reason : unused_) {
      if (!reason.empty()) return reason;
    }
    return "";
  }

  std::vector<Table> tables_;
  std::vector<std::string> unused_;
  std::vector<Entry> entries_;
};

std::vector<Entry> entries_of(const config_detail::Describe& describe) {
  Lister lister;
  describe(lister);
  return lister.entries();
}

std::string last_word(const std::string& key) {
  return key.substr(key.rfind('.') + 1);
}

std::vector<std::string> used_keys(const std::vector<Entry>& entries) {
  std::vector<std::string> keys;
  for (const Entry& entry : entries) {
    if (entry.kind == Entry::Kind::kValue && entry.unused.empty()) keys.push_back(entry.key);
  }
  return keys;
}

/// The used key that probably replaces the unused `key`: the first one in the same top-level table
/// whose last word is that of `key`, or ends with "_" and that word. Empty if there is none.
std::string used_instead(const std::string& key, const std::vector<Entry>& entries) {
  const std::string part = key.substr(0, key.find('.') + 1);
  const std::string name = last_word(key);
  for (const std::string& candidate : used_keys(entries)) {
    const std::string other = last_word(candidate);
    if (candidate.starts_with(part) && (other == name || other.ends_with("_" + name)))
      return candidate;
  }
  return "";
}

std::string hint(const std::string& meant) {
  return meant.empty() ? "" : fmt::format("; did you mean {}?", meant);
}

void add_unused_keys(const config_detail::Describe& describe, config_detail::ReadLog& log) {
  if (log.set_by.empty()) return;
  const std::vector<Entry> entries = entries_of(describe);
  for (const Entry& entry : entries) {
    const auto set_by = log.set_by.find(entry.key);
    if (entry.unused.empty() || entry.key.empty() || set_by == log.set_by.end()) continue;
    log.problems.push_back(fmt::format("{}: {}: {}{}", set_by->second, entry.key, entry.unused,
                                       hint(used_instead(entry.key, entries))));
  }
}

}  // namespace

ConfigError::ConfigError(const std::vector<std::string>& problems)
    : SetupError{join_lines(problems)} {}

void Problems::add(const std::string& key, const std::string& problem) {
  const auto found = locations_.find(key);
  const std::string where = found == locations_.end() ? "" : found->second + ": ";
  lines_.push_back(where + key + ": " + problem);
}

std::vector<std::string> config_detail::read(const ConfigSources& sources, const Describe& describe,
                                             Locations& locations) {
  ReadLog log;
  for (const auto& [name, text] : sources.texts)
    read_toml_text(text, name, describe, log);
  for (const auto& file : sources.files)
    read_toml_file(file, describe, log);
  for (const auto& text : sources.overrides)
    read_toml_override(text, describe, log);
  add_unused_keys(describe, log);
  locations = std::move(log.set_by);
  return log.problems;
}

std::vector<std::string> config_detail::read_part(const std::filesystem::path& file,
                                                  const Describe& describe) {
  ReadLog log;
  read_toml_file(file, describe, log, UnknownKeys::kIgnored);
  return log.problems;
}

// In TOML a value belongs to the last heading before it: a table's values precede its subtables.
std::string config_detail::dump(const Describe& describe) {
  struct Table {
    std::string path{};
    std::string text{};
  };

  std::vector<Table> tables(1);
  for (const Entry& entry : entries_of(describe)) {
    if (!entry.unused.empty()) continue;
    switch (entry.kind) {
      case Entry::Kind::kTable:
        tables.push_back({entry.table, fmt::format("\n[{}]\n", entry.heading)});
        break;
      case Entry::Kind::kElement:
        tables.push_back({entry.table, fmt::format("\n[[{}]]\n", entry.heading)});
        break;
      case Entry::Kind::kEmptyList:
        tables.back().text += fmt::format("# [[{}]]: none. {}\n", entry.heading, entry.meaning);
        break;
      case Entry::Kind::kValue:
        std::ranges::find(tables, entry.table, &Table::path)->text +=
            fmt::format("{} = {}  # {}\n", last_word(entry.key), entry.value, entry.meaning);
        break;
    }
  }
  std::string text;
  for (const Table& table : tables)
    text += table.text;
  return text.substr(std::min(text.find_first_not_of('\n'), text.size()));
}

std::string config_detail::value(const Describe& describe, const std::string& key) {
  const std::vector<Entry> entries = entries_of(describe);
  for (const Entry& entry : entries) {
    if (entry.key != key || entry.kind != Entry::Kind::kValue) continue;
    if (entry.unused.empty()) return entry.text;
    throw ConfigError{
        {fmt::format("{}: {}{}", key, entry.unused, hint(used_instead(key, entries)))}};
  }
  throw ConfigError{
      {fmt::format("{}: unknown key{}", key, hint(nearest_key(key, used_keys(entries))))}};
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/config/toml_reader.hpp"

#include "common/config/nearest_key.hpp"

#include <fmt/format.h>

// toml++ 3.3 asserts on some malformed files ("[" and a control character); without the assertion
// it reports a parse error.
#define TOML_ASSERT(expr) static_assert(true)
#include <toml++/toml.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <set>
#include <sstream>

namespace waymark::config_detail {
namespace {

std::string shown(const toml::node& node) {
  std::ostringstream text;
  if (node.is_table()) return "a table";
  if (node.is_array()) return "an array";
  node.visit([&text](const auto& n) {
    if constexpr (toml::is_floating_point<decltype(n)>) {
      text << fmt::format("{}", n.get());  // shortest: toml++ prints 17 digits
    } else if constexpr (toml::is_value<decltype(n)>) {
      text << n;
    }
  });
  return text.str();
}

/// Reads one table tree into a described struct.
class Reader final : public Fields {
 public:
  Reader(const toml::table& root, std::string source, ReadLog& log, UnknownKeys unknown_keys)
      : source_{std::move(source)}, log_{log}, unknown_keys_{unknown_keys} {
    levels_.push_back({&root, "", {}});
  }

  using Fields::field;

  void field(std::string_view key, bool& value, std::string_view) override {
    if (const toml::node* node = find(key)) read_as(key, *node, value, "true or false");
  }

  void field(std::string_view key, std::string& value, std::string_view) override {
    if (const toml::node* node = find(key)) read_as(key, *node, value, "a string");
  }

  void field(std::string_view key, int& value, Range range, std::string_view) override {
    std::int64_t wide = value;
    range.low = std::max(range.low, double{std::numeric_limits<int>::min()});
    range.high = std::min(range.high, double{std::numeric_limits<int>::max()});
    if (const toml::node* node = find(key)) read_integer(key, *node, wide, range);
    value = static_cast<int>(wide);
  }

  void field(std::string_view key, std::int64_t& value, Range range, std::string_view) override {
    if (const toml::node* node = find(key)) read_integer(key, *node, value, range);
  }

  void field(std::string_view key, double& value, Range range, std::string_view) override {
    if (const toml::node* node = find(key)) read_float(key, *node, value, range);
  }

  void field(std::string_view key, std::vector<int>& value, Range range,
             std::string_view) override {
    read_array(key, value, [&](const toml::node& node, int& element) {
      std::int64_t wide = 0;
      const bool good = read_integer(key, node, wide, range);
      element = static_cast<int>(wide);
      return good;
    });
  }

  void field(std::string_view key, std::vector<double>& value, Range range,
             std::string_view) override {
    read_array(key, value, [&](const toml::node& node, double& element) {
      return read_float(key, node, element, range);
    });
  }

  void field(std::string_view key, std::vector<std::string>& value, std::string_view) override {
    read_array(key, value, [&](const toml::node& node, std::string& element) {
      return read_as(key, node, element, "a string");
    });
  }

  /// Reports unknown keys of the outermost table.
  void finish() { report_unknown_keys(); }

 protected:
  void word(std::string_view key, std::span<const std::string_view> words, std::size_t& index,
            std::string_view) override {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const auto text = node->value<std::string>();
    const auto found = text ? std::find(words.begin(), words.end(), *text) : words.end();
    if (node->is_string() && found != words.end()) {
      index = static_cast<std::size_t>(found - words.begin());
    } else {
      problem(key, *node, fmt::format("one of {}", fmt::join(words, ", ")));
    }
  }

  bool enter(std::string_view key) override {
    const toml::node* node = find(key);
    if (node == nullptr) return false;
    const toml::table* table = node->as_table();
    if (table == nullptr) {
      problem(key, *node, "a table");
      return false;
    }
    levels_.push_back({table, path_of(key) + ".", {}});
    return true;
  }

  bool enter_element(std::string_view key, std::size_t index) override {
    const toml::array* array = find(key) != nullptr ? find(key)->as_array() : nullptr;
    if (array == nullptr || index >= array->size()) return false;
    const toml::table* table = array->get(index)->as_table();
    if (table == nullptr) {
      problem(key, *array->get(index), "a table");
      return false;
    }
    levels_.push_back({table, fmt::format("{}[{}].", path_of(key), index), {}});
    return true;
  }

  void leave() override {
    report_unknown_keys();
    levels_.pop_back();
  }

  bool enter_use(bool, std::string_view) override { return true; }

  void leave_use() override {}

  std::optional<std::size_t> list_size(std::string_view key, std::size_t,
                                       std::string_view) override {
    const toml::node* node = find(key);
    if (node == nullptr) return std::nullopt;
    if (const toml::array* array = node->as_array()) return array->size();
    problem(key, *node, "an array of tables");
    return std::nullopt;
  }

 private:
  struct Level {
    const toml::table* table;
    std::string prefix;
    std::set<std::string, std::less<>> known_keys;
  };

  const toml::node* find(std::string_view key) {
    levels_.back().known_keys.emplace(key);
    const toml::node* node = levels_.back().table->get(key);
    if (node != nullptr && !node->is_table()) log_.set_by[path_of(key)] = where(*node);
    return node;
  }

  std::string path_of(std::string_view key) const {
    return levels_.back().prefix + std::string{key};
  }

  std::string where(const toml::node& node) const {
    const auto line = node.source().begin.line;
    return source_.starts_with("--set") || line == 0 ? source_
                                                     : fmt::format("{}:{}", source_, line);
  }

  void problem(std::string_view key, const toml::node& node, std::string_view expected) {
    log_.problems.push_back(fmt::format("{}: {}: got {}, expected {}", where(node), path_of(key),
                                        shown(node), expected));
  }

  template <class T>
  bool read_as(std::string_view key, const toml::node& node, T& value, std::string_view expected) {
    if (const auto* typed = node.as<T>()) {
      value = typed->get();
      return true;
    }
    problem(key, node, expected);
    return false;
  }

  bool read_integer(std::string_view key, const toml::node& node, std::int64_t& value,
                    Range range) {
    const auto* typed = node.as_integer();
    if (typed == nullptr) {
      problem(key, node, "an integer");
      return false;
    }
    if (!inside(static_cast<double>(typed->get()), range)) {
      problem(key, node, range_text(range));
      return false;
    }
    value = typed->get();
    return true;
  }

  bool read_float(std::string_view key, const toml::node& node, double& value, Range range) {
    if (!node.is_number()) {
      problem(key, node, "a number");
      return false;
    }
    const double number = *node.value<double>();
    if (!std::isfinite(number) || !inside(number, range)) {
      problem(key, node, range_text(range));
      return false;
    }
    value = number;
    return true;
  }

  template <class T, class ReadElement>
  void read_array(std::string_view key, std::vector<T>& value, ReadElement read_element) {
    const toml::node* node = find(key);
    if (node == nullptr) return;
    const toml::array* array = node->as_array();
    if (array == nullptr) {
      problem(key, *node, "an array");
      return;
    }
    std::vector<T> read;
    for (const toml::node& element_node : *array) {
      T element{};
      if (!read_element(element_node, element)) return;
      read.push_back(element);
    }
    value = std::move(read);
  }

  static bool inside(double value, Range range) {
    return value >= range.low && value <= range.high;
  }

  static std::string range_text(Range range) {
    const bool has_low = std::isfinite(range.low);
    const bool has_high = std::isfinite(range.high);
    if (has_low && has_high) return fmt::format("a number from {} to {}", range.low, range.high);
    if (has_low && range.low > 0.0 && range.low < 1e-300) return "a number above 0";
    if (has_low) return fmt::format("a number of at least {}", range.low);
    if (has_high) return fmt::format("a number of at most {}", range.high);
    return "a finite number";
  }

  void report_unknown_keys() {
    if (unknown_keys_ == UnknownKeys::kIgnored) return;
    const Level& level = levels_.back();
    for (const auto& [key, node] : *level.table) {
      if (level.known_keys.contains(key.str())) continue;
      const std::string meant =
          nearest_key(std::string{key.str()}, {level.known_keys.begin(), level.known_keys.end()});
      const std::string hint =
          meant.empty() ? "" : fmt::format("; did you mean {}{}?", level.prefix, meant);
      log_.problems.push_back(
          fmt::format("{}: {}: unknown key{}", where(node), path_of(key.str()), hint));
    }
  }

  std::string source_;
  ReadLog& log_;
  UnknownKeys unknown_keys_;
  std::vector<Level> levels_;
};

void read_table(const toml::table& table, const std::string& source,
                const std::function<void(Fields&)>& describe, ReadLog& log,
                UnknownKeys unknown_keys = UnknownKeys::kProblem) {
  Reader reader{table, source, log, unknown_keys};
  describe(reader);
  reader.finish();
}

std::string described(const toml::parse_error& error) {
  return std::string{error.description()};
}

std::string_view why_not(const std::filesystem::path& file) {
  if (!std::filesystem::exists(file)) return "there is no such file";
  if (std::filesystem::is_directory(file)) return "it is a folder; name a TOML file in it";
  return "no permission, or no regular file";
}

}  // namespace

void read_toml_file(const std::filesystem::path& file, const std::function<void(Fields&)>& describe,
                    ReadLog& log, UnknownKeys unknown_keys) {
  std::ifstream stream{file};
  std::stringstream text;
  if (std::filesystem::is_directory(file) || !stream || !(text << stream.rdbuf())) {
    if (!std::filesystem::is_regular_file(file) || std::filesystem::file_size(file) > 0)
      log.problems.push_back(fmt::format("{}: cannot be read: {}", file.string(), why_not(file)));
    return;
  }
  try {
    read_table(toml::parse(text.str(), file.string()), file.string(), describe, log, unknown_keys);
  } catch (const toml::parse_error& error) {
    log.problems.push_back(fmt::format("{}:{}: not TOML: {}", file.string(),
                                       error.source().begin.line, described(error)));
  }
}

void read_toml_override(const std::string& text, const std::function<void(Fields&)>& describe,
                        ReadLog& log) {
  const std::string source = fmt::format("--set {}", text);
  const auto equals = text.find('=');
  if (equals == std::string::npos || equals == 0) {
    log.problems.push_back(source + ": expected key=value");
    return;
  }
  try {
    read_table(toml::parse(text), source, describe, log);
    return;
  } catch (const toml::parse_error&) {
    // Not a TOML value: a bare word is taken as a string, so that shells need no nested quotes.
  }
  try {
    const std::string quoted = text.substr(0, equals + 1) + "'''" + text.substr(equals + 1) + "'''";
    read_table(toml::parse(quoted), source, describe, log);
  } catch (const toml::parse_error& error) {
    log.problems.push_back(fmt::format("{}: {}", source, described(error)));
  }
}

}  // namespace waymark::config_detail

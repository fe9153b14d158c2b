// SPDX-License-Identifier: BSD-3-Clause
#include "common/config/config.hpp"

#include "common/config/toml_reader.hpp"

#include <fmt/format.h>

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
    if (static_cast<unsigned char>(c) < 0x20) {
      text += fmt::format("\\u{:04X}", static_cast<int>(c));
    } else {
      text += c;
    }
  }
  return text + '"';
}

class Writer final : public Fields {
 public:
  using Fields::field;

  void field(std::string_view key, bool& value, std::string_view meaning) override {
    line(key, value ? "true" : "false", meaning);
  }

  void field(std::string_view key, std::string& value, std::string_view meaning) override {
    line(key, toml_string(value), meaning);
  }

  void field(std::string_view key, int& value, Range, std::string_view meaning) override {
    line(key, fmt::format("{}", value), meaning);
  }

  void field(std::string_view key, std::int64_t& value, Range, std::string_view meaning) override {
    line(key, fmt::format("{}", value), meaning);
  }

  void field(std::string_view key, double& value, Range, std::string_view meaning) override {
    line(key, float_text(value), meaning);
  }

  void field(std::string_view key, std::vector<int>& value, Range,
             std::string_view meaning) override {
    line(key, fmt::format("[{}]", fmt::join(value, ", ")), meaning);
  }

  void field(std::string_view key, std::vector<double>& value, Range,
             std::string_view meaning) override {
    std::vector<std::string> texts;
    for (const double v : value)
      texts.push_back(float_text(v));
    line(key, fmt::format("[{}]", fmt::join(texts, ", ")), meaning);
  }

  void field(std::string_view key, std::vector<std::string>& value,
             std::string_view meaning) override {
    std::vector<std::string> texts;
    for (const std::string& v : value)
      texts.push_back(toml_string(v));
    line(key, fmt::format("[{}]", fmt::join(texts, ", ")), meaning);
  }

  const std::string& text() const { return text_; }

 protected:
  void word(std::string_view key, std::span<const std::string_view> words, std::size_t& index,
            std::string_view meaning) override {
    line(key, toml_string(std::string{words[index]}),
         fmt::format("{} ({})", meaning, fmt::join(words, " | ")));
  }

  bool enter(std::string_view key) override {
    path_.emplace_back(key);
    text_ += fmt::format("\n[{}]\n", fmt::join(path_, "."));
    return true;
  }

  bool enter_element(std::string_view key, std::size_t) override {
    path_.emplace_back(key);
    text_ += fmt::format("\n[[{}]]\n", fmt::join(path_, "."));
    return true;
  }

  void leave() override { path_.pop_back(); }

  std::optional<std::size_t> list_size(std::string_view key, std::size_t current_size,
                                       std::string_view meaning) override {
    if (current_size == 0) text_ += fmt::format("# [[{}]]: none. {}\n", key, meaning);
    return std::nullopt;
  }

 private:
  void line(std::string_view key, const std::string& value, std::string_view meaning) {
    text_ += fmt::format("{} = {}  # {}\n", key, value, meaning);
  }

  std::vector<std::string> path_;
  std::string text_;
};

}  // namespace

ConfigError::ConfigError(const std::vector<std::string>& problems)
    : std::runtime_error{join_lines(problems)} {}

void Problems::add(std::string key, std::string problem) {
  lines_.push_back(std::move(key) + ": " + std::move(problem));
}

std::vector<std::string> config_detail::read(const ConfigSources& sources,
                                             const Describe& describe) {
  std::vector<std::string> problems;
  for (const auto& file : sources.files)
    read_toml_file(file, describe, problems);
  for (const auto& text : sources.overrides)
    read_toml_override(text, describe, problems);
  return problems;
}

std::vector<std::string> config_detail::read_part(const std::filesystem::path& file,
                                                  const Describe& describe) {
  std::vector<std::string> problems;
  read_toml_file(file, describe, problems, UnknownKeys::kIgnored);
  return problems;
}

std::string config_detail::dump(const Describe& describe) {
  Writer writer;
  describe(writer);
  const std::string& text = writer.text();
  return text.substr(
      text.find_first_not_of('\n') == std::string::npos ? 0 : text.find_first_not_of('\n'));
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/files/text_file.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <sstream>

namespace waymark::evaluate {
namespace {

constexpr std::string_view kSeparators = " \t,";

std::vector<std::string> split(std::string_view line) {
  std::vector<std::string> words;
  for (std::size_t begin = line.find_first_not_of(kSeparators); begin != std::string_view::npos;) {
    const std::size_t end = line.find_first_of(kSeparators, begin);
    words.emplace_back(line.substr(begin, end - begin));
    begin = line.find_first_not_of(kSeparators, end);
  }
  return words;
}

/// A finite number that takes the whole word.
std::optional<double> parse_number(const std::string& word) {
  double number{};
  const char* const end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, number);
  if (error != std::errc{} || stop != end || !std::isfinite(number)) return std::nullopt;
  return number;
}

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  std::ifstream input{file, std::ios::binary};
  if (!input.is_open() || std::filesystem::is_directory(file))
    throw SetupError{
        fmt::format("{}: cannot be read; give the path of an existing file", file.string())};
  std::string text{std::istreambuf_iterator<char>{input}, {}};
  if (input.bad()) throw SetupError{fmt::format("{}: reading failed", file.string())};
  return text;
}

std::vector<std::string> read_lines(const std::filesystem::path& file) {
  std::istringstream text{read_text(file)};
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);) {
    if (!line.empty() && line.back() == '\r') line.pop_back();
    lines.push_back(line);
  }
  return lines;
}

std::optional<std::vector<double>> parse_numbers(std::string_view line) {
  std::vector<double> numbers;
  for (const std::string& word : split(line)) {
    const auto number = parse_number(word);
    if (!number) return std::nullopt;
    numbers.push_back(*number);
  }
  return numbers;
}

std::string at_line(const std::filesystem::path& file, std::size_t line_number,
                    std::string_view reason) {
  return fmt::format("{}:{}: {}", file.string(), line_number, reason);
}

CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& columns,
                  SkippedLines& skipped) {
  const std::vector<std::string> lines = read_lines(file);
  const std::vector<std::string> names =
      lines.empty() ? std::vector<std::string>{} : split(lines.front());
  CsvTable table;
  std::vector<std::size_t> places;  // places of the wanted columns in a line
  for (const std::string& column : columns) {
    const auto place = std::find(names.begin(), names.end(), column);
    if (place == names.end())
      throw SetupError{at_line(file, 1,
                               fmt::format("no column '{}'; the first line must be '{}'", column,
                                           fmt::join(columns, ",")))};
    table.column_of[column] = places.size();
    places.push_back(static_cast<std::size_t>(place - names.begin()));
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const std::vector<std::string> words = split(lines[i]);
    std::vector<double> row;
    for (const std::size_t place : places) {
      const auto number = words.size() == names.size() ? parse_number(words[place]) : std::nullopt;
      if (number) row.push_back(*number);
    }
    if (row.size() == places.size())
      table.rows.push_back(row);
    else
      skipped.push_back(at_line(file, i + 1,
                                fmt::format("got '{}', expected finite numbers for {}", lines[i],
                                            fmt::join(columns, ","))));
  }
  return table;
}

}  // namespace waymark::evaluate

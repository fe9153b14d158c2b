// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/text_file.hpp"

#include <fmt/format.h>

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

}  // namespace

std::string read_text(const std::filesystem::path& file) {
  std::ifstream input{file, std::ios::binary};
  if (!input.is_open() || std::filesystem::is_directory(file))
    throw InputError{
        fmt::format("{}: cannot be read; give the path of an existing file", file.string())};
  std::string text{std::istreambuf_iterator<char>{input}, {}};
  if (input.bad()) throw InputError{fmt::format("{}: reading failed", file.string())};
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
    double number{};
    const char* const end = word.data() + word.size();
    const auto [stop, error] = std::from_chars(word.data(), end, number);
    if (error != std::errc{} || stop != end || !std::isfinite(number)) return std::nullopt;
    numbers.push_back(number);
  }
  return numbers;
}

std::string at_line(const std::filesystem::path& file, std::size_t line_number,
                    std::string_view reason) {
  return fmt::format("{}:{}: {}", file.string(), line_number, reason);
}

CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& columns,
                  Skipped& skipped) {
  const std::vector<std::string> lines = read_lines(file);
  const std::vector<std::string> names =
      lines.empty() ? std::vector<std::string>{} : split(lines.front());
  CsvTable table;
  for (std::size_t i = 0; i < names.size(); ++i)
    table.column_of[names[i]] = i;
  for (const std::string& column : columns) {
    if (!table.column_of.contains(column))
      throw InputError{at_line(file, 1,
                               fmt::format("no column '{}'; the first line must be '{}'", column,
                                           fmt::join(columns, ",")))};
  }
  for (std::size_t i = 1; i < lines.size(); ++i) {
    if (lines[i].empty()) continue;
    const auto numbers = parse_numbers(lines[i]);
    if (numbers && numbers->size() == names.size())
      table.rows.push_back(*numbers);
    else
      skipped.push_back(
          at_line(file, i + 1,
                  fmt::format("got '{}', expected {} finite numbers", lines[i], names.size())));
  }
  return table;
}

void write_whole_file(const std::filesystem::path& file, std::string_view text) {
  const std::filesystem::path temporary = file.string() + ".tmp";
  {
    std::ofstream output{temporary, std::ios::binary};
    output << text;
    output.flush();
    if (!output)
      throw InputError{
          fmt::format("{}: cannot be written; check the folder and its rights", file.string())};
  }
  std::error_code error;
  std::filesystem::rename(temporary, file, error);
  if (error)
    throw InputError{fmt::format("{}: cannot be written: {}", file.string(), error.message())};
}

}  // namespace waymark::evaluate

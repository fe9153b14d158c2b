// SPDX-License-Identifier: BSD-3-Clause
// Text files: lines, numbers, comma-separated tables.
#pragma once

#include "common/errors/setup_error.hpp"

#include <cstddef>
#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace waymark::evaluate {

/// Lines that were left out, as "file:line: reason".
using SkippedLines = std::vector<std::string>;

/// @throws SetupError if the file cannot be read.
std::string read_text(const std::filesystem::path& file);

/// Lines without their ends ("\n" or "\r\n"). @throws SetupError if the file cannot be read.
std::vector<std::string> read_lines(const std::filesystem::path& file);

/// Finite numbers separated by white space or commas; nullopt if the line has anything else.
std::optional<std::vector<double>> parse_numbers(std::string_view line);

/// "file:line: reason"
std::string at_line(const std::filesystem::path& file, std::size_t line_number,
                    std::string_view reason);

/// Comma-separated numbers below a line of names. Columns are found by name, so that their order is
/// free and further ones are allowed.
struct CsvTable {
  std::map<std::string, std::size_t, std::less<>> column_of{};
  std::vector<std::vector<double>> rows{};

  double at(const std::vector<double>& row, std::string_view column) const {
    return row[column_of.find(column)->second];
  }
};

/// Reads the named columns; others may hold any words. Lines whose named columns are not finite
/// numbers, or that have another number of words than the first line, are added to `skipped`.
/// @throws SetupError if the file cannot be read or a column is missing.
CsvTable read_csv(const std::filesystem::path& file, const std::vector<std::string>& columns,
                  SkippedLines& skipped);

}  // namespace waymark::evaluate

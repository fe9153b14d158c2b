// SPDX-License-Identifier: BSD-3-Clause
// Log lines on standard error, by spdlog. Only logging.cpp includes spdlog, whose headers compile
// most of fmt again.
#pragma once

#include <fmt/format.h>

#include <string>
#include <string_view>
#include <utility>

namespace waymark::logging {

enum class Level { kInfo, kWarn, kError };

/// Makes every line begin with the time and the name of the program.
void begin(const std::string& program);

/// Lines below this level are left out.
void set_level(Level level);

void write(Level level, std::string_view line);

template <typename... Args>
void info(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kInfo, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void warn(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kWarn, fmt::format(format, std::forward<Args>(args)...));
}

template <typename... Args>
void error(fmt::format_string<Args...> format, Args&&... args) {
  write(Level::kError, fmt::format(format, std::forward<Args>(args)...));
}

}  // namespace waymark::logging

// SPDX-License-Identifier: BSD-3-Clause
#include "common/logging/logging.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace waymark::logging {
namespace {

spdlog::level::level_enum spdlog_level(Level level) {
  switch (level) {
    case Level::kInfo:
      return spdlog::level::info;
    case Level::kWarn:
      return spdlog::level::warn;
    case Level::kError:
      break;
  }
  return spdlog::level::err;
}

}  // namespace

void begin(const std::string& program) {
  spdlog::set_default_logger(spdlog::stderr_color_mt(program));
  spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
}

void set_level(Level level) {
  spdlog::set_level(spdlog_level(level));
}

void write(Level level, std::string_view line) {
  spdlog::default_logger_raw()->log(spdlog::source_loc{}, spdlog_level(level),
                                    spdlog::string_view_t{line.data(), line.size()});
}

}  // namespace waymark::logging

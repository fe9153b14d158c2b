// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/guard.hpp"

#include "common/config/config.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/runtime/signals.hpp"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

namespace waymark {

int run_guarded(const ProcessTraits& traits, const std::function<int()>& body) {
  const std::string name{traits.name};
  spdlog::set_default_logger(spdlog::stderr_color_mt(name));
  spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$: %v");
  install_stop_signals();
  try {
    return body();
  } catch (const ConfigError& error) {
    spdlog::error("configuration:\n{}", error.what());
    return kExitUsage;
  } catch (const SetupError& error) {
    spdlog::error("{}", error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    spdlog::error("{}", error.what());
    return kExitFailed;
  }
}

void log_counters(const Counters& counters) {
  std::string text;
  for (const auto& [name, count] : counters.all()) {
    if (count != 0) text += (text.empty() ? "" : ", ") + name + " " + std::to_string(count);
  }
  spdlog::info("counted: {}", text.empty() ? "nothing" : text);
}

}  // namespace waymark

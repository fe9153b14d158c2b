// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/guard.hpp"

#include "common/config/config.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/runtime/signals.hpp"

#include <fmt/format.h>
#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include <map>
#include <utility>

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
  std::map<CountKind, std::string> texts;
  for (const auto& [name, count] : counters.all()) {
    std::string& text = texts[count.kind];
    if (count.value != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.value);
  }
  spdlog::info("counted: {}",
               texts[CountKind::kEvent].empty() ? "nothing" : texts[CountKind::kEvent]);
  for (const auto& [kind, name] :
       {std::pair{CountKind::kLoss, "lost"}, std::pair{CountKind::kRejection, "rejected"}}) {
    if (!texts[kind].empty()) spdlog::warn("{}: {}", name, texts[kind]);
  }
}

}  // namespace waymark

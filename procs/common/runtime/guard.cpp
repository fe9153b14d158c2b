// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/guard.hpp"

#include "common/command_line/run_tool.hpp"
#include "common/config/config.hpp"
#include "common/logging/logging.hpp"
#include "common/runtime/signals.hpp"

#include <fmt/format.h>

#include <map>
#include <utility>

namespace waymark {
int run_guarded(const ProcessTraits& traits, const std::function<int()>& body) {
  logging::begin(std::string{traits.name});
  install_stop_signals();
  const auto work = [&] {
    try {
      return body();
    } catch (const ConfigError& error) {
      throw SetupError{fmt::format("configuration:\n{}", error.what())};
    }
  };
  return run_and_report(work, [](std::string_view what) { logging::error("{}", what); });
}

bool run_and_log_errors(const std::function<void()>& work) {
  try {
    work();
    return true;
  } catch (const std::exception& error) {
    logging::error("the run ends here: {}", error.what());
    return false;
  }
}

void log_counters(const Counters& counters) {
  std::map<CountKind, std::string> texts;
  for (const auto& [name, count] : counters.all()) {
    std::string& text = texts[count.kind];
    if (count.value != 0)
      text += fmt::format("{}{} {}", text.empty() ? "" : ", ", name, count.value);
  }
  logging::info("counted: {}",
                texts[CountKind::kEvent].empty() ? "nothing" : texts[CountKind::kEvent]);
  for (const auto& [kind, name] :
       {std::pair{CountKind::kLoss, "lost"}, std::pair{CountKind::kRejection, "rejected"}}) {
    if (!texts[kind].empty()) logging::warn("{}: {}", name, texts[kind]);
  }
}

}  // namespace waymark

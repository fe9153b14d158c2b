// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/guard.hpp"

#include "common/config/config.hpp"
#include "common/errors/exit_codes.hpp"
#include "common/logging/logging.hpp"
#include "common/runtime/signals.hpp"

#include <fmt/format.h>

#include <cerrno>
#include <cstdio>
#include <map>
#include <system_error>
#include <utility>

namespace waymark {
namespace {

/// Flushes standard output, as a write to a full disk may fail only then.
/// @return `code`, or kExitFailed in place of kExitOk if output is lost.
int flush_output(int code) {
  if (std::fflush(stdout) == 0) return code;
  logging::error("standard output cannot be written: {}", std::generic_category().message(errno));
  return code == kExitOk ? int{kExitFailed} : code;
}

}  // namespace

int run_guarded(const ProcessTraits& traits, const std::function<int()>& body) {
  logging::begin(std::string{traits.name});
  install_stop_signals();
  try {
    return flush_output(body());
  } catch (const ConfigError& error) {
    logging::error("configuration:\n{}", error.what());
    return kExitUsage;
  } catch (const SetupError& error) {
    logging::error("{}", error.what());
    return kExitUsage;
  } catch (const std::exception& error) {
    logging::error("{}", error.what());
    return kExitFailed;
  }
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

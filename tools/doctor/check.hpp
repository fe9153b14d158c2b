// SPDX-License-Identifier: BSD-3-Clause
// What the doctor says about one thing.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waymark {

enum class Verdict { kPass, kWarn, kFail };

struct Check {
  std::string name{};
  Verdict verdict{Verdict::kWarn};
  std::string finding{};          ///< one sentence, with its number
  std::string remedy{};           ///< what to do; empty when there is nothing to do
  std::optional<double> value{};  ///< the number, in the unit of its name
  bool is_made{true};             ///< false: the log does not say; never a PASS
};

/// A check that this log does not allow.
inline Check not_made(std::string name, std::string why, std::string remedy) {
  return {std::move(name),
          Verdict::kWarn,
          "cannot be checked: " + std::move(why),
          std::move(remedy),
          {},
          false};
}

}  // namespace waymark

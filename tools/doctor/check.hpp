// SPDX-License-Identifier: BSD-3-Clause
// What the doctor says about one thing.
#pragma once

#include <optional>
#include <string>
#include <vector>

namespace waymark {

/// kUnchecked: this log does not say; it is no PASS.
enum class Verdict { kPass, kWarn, kFail, kUnchecked };

struct Check {
  std::string name{};
  Verdict verdict{Verdict::kUnchecked};
  std::string finding{};          ///< one sentence, with its number
  std::string remedy{};           ///< what to do; empty when there is nothing to do
  std::optional<double> value{};  ///< the number, in the unit of its name
};

/// A check that this log does not allow.
inline Check unchecked(std::string name, std::string why, std::string remedy) {
  return {std::move(name),
          Verdict::kUnchecked,
          "could not be checked: " + std::move(why),
          std::move(remedy),
          {}};
}

}  // namespace waymark

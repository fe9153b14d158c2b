// SPDX-License-Identifier: BSD-3-Clause
// The result of one check.
#pragma once

#include <optional>
#include <string>

namespace waymark {

/// kUnchecked: the log does not allow this check. That is not a PASS.
enum class Verdict { kPass, kWarn, kFail, kUnchecked };

struct Check {
  std::string name{};
  Verdict verdict{Verdict::kUnchecked};
  std::string finding{};          ///< one sentence with the measured value
  std::string remedy{};           ///< what to do; may be empty
  std::optional<double> value{};  ///< the measured value; unit: table in README.md
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

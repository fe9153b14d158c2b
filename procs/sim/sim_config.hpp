// SPDX-License-Identifier: BSD-3-Clause
// The simulator's configuration: a scenario, and where to write what is true.
#pragma once

#include "sim/core/scenario.hpp"

#include <filesystem>

namespace waymark {

struct SimConfig : Scenario {
  std::filesystem::path out_dir{};  ///< from --out; empty = write nothing
};

}  // namespace waymark

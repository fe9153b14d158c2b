// SPDX-License-Identifier: BSD-3-Clause
// The simulator's configuration: a scenario, and the folder for the ground truth.
#pragma once

#include "sim/core/scenario.hpp"

#include <filesystem>

namespace waymark {

struct SimConfig : Scenario {
  std::filesystem::path out_dir{};  ///< from --out; empty = write nothing
};

}  // namespace waymark

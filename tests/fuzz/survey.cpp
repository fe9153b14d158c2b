// SPDX-License-Identifier: BSD-3-Clause
// Input: a table of surveyed markers.
#include "common/errors/setup_error.hpp"
#include "memory_file.hpp"
#include "slam/survey_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    waymark::read_survey(waymark::fuzz::memory_file({data, size}), "DICT_6X6_250");
  } catch (const waymark::SetupError&) {
  }
  return 0;
}

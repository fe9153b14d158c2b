// SPDX-License-Identifier: BSD-3-Clause
// Input: a CARMEN log, plain or compressed.
#include "common/errors/setup_error.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark;
  const auto file = fuzz::memory_file({data, size});
  ImportReport report{file, AddressUnit::kLine};
  try {
    read_carmen_log(file, {}, report);
  } catch (const SetupError&) {
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Input: a ROS bag, .bag or .mcap. (SQLite opens no file in memory, and its authors fuzz it.)
#include "common/errors/setup_error.hpp"
#include "import/rosbag/rosbag_reader.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark;
  const auto file = fuzz::memory_file({data, size});
  ImportReport report{file, AddressUnit::kByte};
  try {
    read_rosbag(file, {}, report);
  } catch (const SetupError&) {
  }
  return 0;
}

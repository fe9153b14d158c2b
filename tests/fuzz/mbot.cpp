// SPDX-License-Identifier: BSD-3-Clause
// Input: an LCM log with the channels of another robot.
#include "common/errors/setup_error.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "memory_file.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark;
  const auto file = fuzz::memory_file({data, size});
  ImportReport report{file, AddressUnit::kByte};
  MbotOptions options;
  options.lidar_channel = "LIDAR";
  options.odometry_channel = "ODOMETRY";
  options.reference_channel = "TRUE_POSE";
  try {
    read_mbot_log(file, options, report);
  } catch (const SetupError&) {
  }
  return 0;
}

// SPDX-License-Identifier: BSD-3-Clause
// Input: a configuration file of slam, which has the largest configuration. An accepted one can be
// printed and read back.
#include "common/runtime/run_process.hpp"
#include "memory_file.hpp"
#include "slam/slam_config.hpp"

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  using namespace waymark;
  std::string printed;
  try {
    const auto config =
        load_config<ProcessConfig<SlamConfig>>({{fuzz::memory_file({data, size})}, {}});
    printed = dump_config(config);
  } catch (const ConfigError&) {
    return 0;
  }
  const std::span bytes{reinterpret_cast<const std::uint8_t*>(printed.data()), printed.size()};
  load_config<ProcessConfig<SlamConfig>>({{fuzz::memory_file(bytes)}, {}});
  return 0;
}

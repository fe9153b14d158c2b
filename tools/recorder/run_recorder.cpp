// SPDX-License-Identifier: BSD-3-Clause
#include "recorder/run_recorder.hpp"

#include "common/runtime/run_process.hpp"
#include "recorder/recorder_node.hpp"

namespace waymark {

int run_recorder(int argc, char** argv) {
  return run_process<RecorderNode>(argc, argv);
}

}  // namespace waymark

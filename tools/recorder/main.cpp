// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/run_process.hpp"
#include "recorder/recorder_node.hpp"

int main(int argc, char** argv) {
  return waymark::run_process<waymark::RecorderNode>(argc, argv);
}

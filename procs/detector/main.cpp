// SPDX-License-Identifier: BSD-3-Clause
// waymark-detector
#include "common/runtime/run_process.hpp"
#include "detector/detector_node.hpp"

int main(int argc, char** argv) {
  return waymark::run_process<waymark::DetectorNode>(argc, argv);
}

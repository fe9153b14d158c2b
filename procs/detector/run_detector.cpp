// SPDX-License-Identifier: BSD-3-Clause
#include "detector/run_detector.hpp"

#include "common/runtime/run_process.hpp"
#include "detector/detector_node.hpp"

namespace waymark {

int run_detector(int argc, char** argv) {
  return run_process<DetectorNode>(argc, argv);
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/run_slam.hpp"

#include "common/runtime/run_process.hpp"
#include "slam/slam_node.hpp"

namespace waymark {

int run_slam(int argc, char** argv) {
  return run_process<SlamNode>(argc, argv);
}

}  // namespace waymark

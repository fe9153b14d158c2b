// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/run_process.hpp"
#include "slam/slam_node.hpp"

int main(int argc, char** argv) {
  return waymark::run_process<waymark::SlamNode>(argc, argv);
}

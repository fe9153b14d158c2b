// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/run_process.hpp"
#include "viewer/viewer_node.hpp"

int main(int argc, char** argv) {
  return waymark::run_process<waymark::ViewerNode>(argc, argv);
}

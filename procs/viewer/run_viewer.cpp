// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/run_viewer.hpp"

#include "common/runtime/run_process.hpp"
#include "viewer/viewer_node.hpp"

namespace waymark {

int run_viewer(int argc, char** argv) {
  return run_process<ViewerNode>(argc, argv);
}

}  // namespace waymark

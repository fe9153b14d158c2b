// SPDX-License-Identifier: BSD-3-Clause
#include "sim/sim_node.hpp"

int main(int argc, char** argv) {
  return waymark::run_simulator<waymark::SimNode>(argc, argv);
}

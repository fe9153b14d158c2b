// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run_sim.hpp"

#include "common/runtime/run_simulator.hpp"
#include "sim/sim_node.hpp"

namespace waymark {

int run_sim(int argc, char** argv) {
  return run_simulator<SimNode>(argc, argv);
}

}  // namespace waymark

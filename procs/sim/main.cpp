// SPDX-License-Identifier: BSD-3-Clause
#include "sim/run_sim.hpp"

int main(int argc, char** argv) {
  return waymark::run_sim(argc, argv);
}

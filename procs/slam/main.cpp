// SPDX-License-Identifier: BSD-3-Clause
#include "slam/run_slam.hpp"

int main(int argc, char** argv) {
  return waymark::run_slam(argc, argv);
}

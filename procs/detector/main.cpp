// SPDX-License-Identifier: BSD-3-Clause
#include "detector/run_detector.hpp"

int main(int argc, char** argv) {
  return waymark::run_detector(argc, argv);
}

// SPDX-License-Identifier: BSD-3-Clause
#include "recorder/run_recorder.hpp"

int main(int argc, char** argv) {
  return waymark::run_recorder(argc, argv);
}

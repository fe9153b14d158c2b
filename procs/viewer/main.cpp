// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/run_viewer.hpp"

int main(int argc, char** argv) {
  return waymark::run_viewer(argc, argv);
}

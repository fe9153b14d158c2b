// SPDX-License-Identifier: BSD-3-Clause
// main() of waymark-sim, compiled with the node: main.cpp needs none of its headers.
#pragma once

namespace waymark {

int run_sim(int argc, char** argv);

}  // namespace waymark

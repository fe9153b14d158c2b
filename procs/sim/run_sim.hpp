// SPDX-License-Identifier: BSD-3-Clause
// main() of waymark-sim; its own file, so that main.cpp needs none of the node's headers.
#pragma once

namespace waymark {

int run_sim(int argc, char** argv);

}  // namespace waymark

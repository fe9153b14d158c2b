// SPDX-License-Identifier: BSD-3-Clause
// main() of waymark-recorder; its own file, so that main.cpp needs none of the node's headers.
#pragma once

namespace waymark {

int run_recorder(int argc, char** argv);

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// main() of waymark-viewer, compiled with the node: main.cpp needs none of its headers.
#pragma once

namespace waymark {

int run_viewer(int argc, char** argv);

}  // namespace waymark

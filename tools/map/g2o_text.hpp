// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "slam/core/graph/map_snapshot.hpp"

#include <string>

namespace waymark {

/// A pose graph as other tools read it: VERTEX_SE2 id x y theta; EDGE_SE2 from to x y theta and the
/// upper triangle of the information, row by row; [m, rad]. The first vertex is fixed (FIX 0).
/// Source: g2o's wiki, "File format".
std::string g2o_text(const PoseGraph& graph);

}  // namespace waymark

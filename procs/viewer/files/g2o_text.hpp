// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include "common/messages/channels.hpp"

#include <span>
#include <string>

namespace waymark::viewer {

/// A pose graph in g2o's format: VERTEX_SE2 id x y theta; EDGE_SE2 from to x y theta and the
/// upper triangle of the information, row by row, in the axes of `to`; [m, rad]. The first vertex
/// is fixed (FIX 0). Source: g2o's wiki, "File format".
/// @param parts  of one graph, in order.
std::string g2o_text(std::span<const pose_graph_t> parts);

}  // namespace waymark::viewer

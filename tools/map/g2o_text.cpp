// SPDX-License-Identifier: BSD-3-Clause
#include "map/g2o_text.hpp"

#include <fmt/format.h>

#include <iterator>

namespace waymark {

std::string g2o_text(const PoseGraph& graph) {
  std::string text;
  auto out = std::back_inserter(text);
  for (std::size_t i = 0; i < graph.poses.size(); ++i) {
    const Se2& pose = graph.poses[i];
    fmt::format_to(out, "VERTEX_SE2 {} {:.9g} {:.9g} {:.9g}\n", i, pose.x(), pose.y(),
                   pose.theta());
  }
  if (!graph.poses.empty()) text += "FIX 0\n";
  for (const GraphEdge& edge : graph.edges) {
    const Eigen::Matrix3d& information = edge.information;
    fmt::format_to(
        out, "EDGE_SE2 {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n",
        edge.from, edge.to, edge.from_from_to.x(), edge.from_from_to.y(), edge.from_from_to.theta(),
        information(0, 0), information(0, 1), information(0, 2), information(1, 1),
        information(1, 2), information(2, 2));
  }
  return text;
}

}  // namespace waymark

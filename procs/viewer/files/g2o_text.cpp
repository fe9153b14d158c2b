// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/files/g2o_text.hpp"

#include "common/geometry/se2.hpp"

#include <fmt/format.h>

namespace waymark::viewer {
namespace {

/// The edge's information in the axes of `to`; the message has it in those of `from`.
Eigen::Matrix3d information_in_to(const graph_edge_t& edge) {
  const auto& upper = edge.information;
  Eigen::Matrix3d in_from;
  in_from << upper[0], upper[1], upper[2], upper[1], upper[3], upper[4], upper[2], upper[4],
      upper[5];
  Eigen::Matrix3d to_from = Eigen::Matrix3d::Identity();
  to_from.topLeftCorner<2, 2>() = Se2{0.0, 0.0, edge.pose[2]}.rotation().transpose();
  return to_from * in_from * to_from.transpose();
}

}  // namespace

std::string g2o_text(std::span<const pose_graph_t> parts) {
  std::string text;
  int vertex = 0;
  for (const pose_graph_t& part : parts)
    for (const auto& pose : part.vertices)
      text +=
          fmt::format("VERTEX_SE2 {} {:.9g} {:.9g} {:.9g}\n", vertex++, pose[0], pose[1], pose[2]);
  if (vertex > 0) text += "FIX 0\n";
  for (const pose_graph_t& part : parts) {
    for (const graph_edge_t& edge : part.edges) {
      const Eigen::Matrix3d information = information_in_to(edge);
      text += fmt::format(
          "EDGE_SE2 {} {} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g} {:.9g}\n",
          edge.from_vertex, edge.to_vertex, edge.pose[0], edge.pose[1], edge.pose[2],
          information(0, 0), information(0, 1), information(0, 2), information(1, 1),
          information(1, 2), information(2, 2));
    }
  }
  return text;
}

}  // namespace waymark::viewer

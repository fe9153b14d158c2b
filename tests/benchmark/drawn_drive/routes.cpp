// SPDX-License-Identifier: BSD-3-Clause
#include "drawn_drive/routes.hpp"

#include <opencv2/imgproc.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <queue>
#include <utility>

namespace waymark::drawn {
namespace {

constexpr int kNode = 5;           // cells
constexpr double kRobot_m = 0.4;   // clearance that a way needs
constexpr double kLikes_m = 0.9;   // and that it likes
constexpr double kDislikes = 3.0;  // cost of a metre without, per metre
constexpr int kSmoothings = 30;

}  // namespace

Routes::Routes(const Building& building)
    : columns_{building.columns()},
      node_columns_{building.columns() / kNode},
      node_rows_{building.rows() / kNode} {
  cv::Mat1b is_free(building.rows(), building.columns());
  for (int row = 0; row < building.rows(); ++row)
    for (int column = 0; column < building.columns(); ++column)
      is_free(row, column) = building.is_wall(column, row) ? 0 : 255;
  cv::Mat1f cells;
  cv::distanceTransform(is_free, cells, cv::DIST_L2, 5);
  for (const float distance : cells)
    clearance_m_.push_back(static_cast<float>(Building::kCell_m) * distance);

  std::vector<bool> is_known(static_cast<std::size_t>(node_columns_ * node_rows_), false);
  for (int start = 0; start < node_columns_ * node_rows_; ++start) {
    if (is_known[static_cast<std::size_t>(start)] || !is_open(start)) continue;
    std::vector<int> part{start};
    is_known[static_cast<std::size_t>(start)] = true;
    for (std::size_t i = 0; i < part.size(); ++i) {
      for (const int next : neighbours(part[i])) {
        if (is_known[static_cast<std::size_t>(next)]) continue;
        is_known[static_cast<std::size_t>(next)] = true;
        part.push_back(next);
      }
    }
    if (part.size() > reachable_.size()) reachable_ = std::move(part);
  }
}

Eigen::Vector2d Routes::place(Random& random) const {
  const double at = random.uniform(0.0, static_cast<double>(reachable_.size()));
  return place_of(reachable_[static_cast<std::size_t>(at)]);
}

double Routes::clearance_m(const Eigen::Vector2d& place) const {
  const Eigen::Array2i cell = (place / Building::kCell_m).array().floor().cast<int>();
  return clearance_m_[static_cast<std::size_t>(cell.y() * columns_ + cell.x())];
}

int Routes::node_at(const Eigen::Vector2d& place) const {
  const Eigen::Array2i cell = (place / (kNode * Building::kCell_m)).array().floor().cast<int>();
  return cell.y() * node_columns_ + cell.x();
}

Eigen::Vector2d Routes::place_of(int node) const {
  return kNode * Building::kCell_m *
         Eigen::Vector2d{node % node_columns_ + 0.5, node / node_columns_ + 0.5};
}

bool Routes::is_open(int node) const {
  return clearance_m(place_of(node)) > kRobot_m;
}

std::vector<int> Routes::neighbours(int node) const {
  std::vector<int> open;
  for (int y = -1; y <= 1; ++y) {
    for (int x = -1; x <= 1; ++x) {
      const int column = node % node_columns_ + x;
      const int row = node / node_columns_ + y;
      if ((x == 0 && y == 0) || column < 0 || row < 0 || column >= node_columns_ ||
          row >= node_rows_) {
        continue;
      }
      const int next = row * node_columns_ + column;
      if (is_open(next)) open.push_back(next);
    }
  }
  return open;
}

/// Dijkstra's.
std::vector<Eigen::Vector2d> Routes::way(const Eigen::Vector2d& from,
                                         const Eigen::Vector2d& to) const {
  using Step = std::pair<double, int>;
  const auto nodes = static_cast<std::size_t>(node_columns_ * node_rows_);
  std::vector<double> cost(nodes, std::numeric_limits<double>::infinity());
  std::vector<int> before(nodes, -1);
  std::priority_queue<Step, std::vector<Step>, std::greater<>> next;
  const int goal = node_at(to);
  next.emplace(0.0, node_at(from));
  cost[static_cast<std::size_t>(node_at(from))] = 0.0;
  while (!next.empty() && next.top().second != goal) {
    const auto [so_far, node] = next.top();
    next.pop();
    if (so_far > cost[static_cast<std::size_t>(node)]) continue;
    for (const int neighbour : neighbours(node)) {
      const double narrow_m = std::max(0.0, kLikes_m - clearance_m(place_of(neighbour)));
      const double there =
          so_far + (place_of(neighbour) - place_of(node)).norm() * (1.0 + kDislikes * narrow_m);
      if (there >= cost[static_cast<std::size_t>(neighbour)]) continue;
      cost[static_cast<std::size_t>(neighbour)] = there;
      before[static_cast<std::size_t>(neighbour)] = node;
      next.emplace(there, neighbour);
    }
  }
  std::vector<Eigen::Vector2d> way;
  for (int node = goal; node >= 0; node = before[static_cast<std::size_t>(node)])
    way.push_back(place_of(node));
  std::reverse(way.begin(), way.end());
  for (int i = 0; i < kSmoothings; ++i) {
    for (std::size_t k = 1; k + 1 < way.size(); ++k) {
      const Eigen::Vector2d between = 0.25 * (way[k - 1] + 2.0 * way[k] + way[k + 1]);
      if (clearance_m(between) > kRobot_m) way[k] = between;
    }
  }
  return way;
}

}  // namespace waymark::drawn

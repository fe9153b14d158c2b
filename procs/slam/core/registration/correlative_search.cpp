// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/correlative_search.hpp"

#include "common/geometry/median.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <iterator>
#include <limits>
#include <numbers>

namespace waymark {
namespace {

constexpr int kFull = 255;           // the byte that represents a field value of 1
constexpr int kTopLevel = 6;         // of 64 cells: 3.2 m at 5 cm
constexpr int kMaxHalfSide = 1024;   // [cells] from the median: 51 m at 5 cm, beyond indoor LiDARs
constexpr double kSigmas = 3.0;      // where the Gaussian is cut: 0.011, three steps of a byte
constexpr int kMaxWindow = 1 << 20;  // [cells] on each side of the guess
constexpr double kFar_cells = 1e8;   // farther cells are clamped: int must not overflow
constexpr double kMinAngularStep_rad = 5e-4;  // one cell of 5 cm at 100 m; bounds the headings

/// Component-wise; needs a point.
Eigen::Vector2d median(std::span<const Eigen::Vector2d> points) {
  std::vector<double> xs;
  std::vector<double> ys;
  for (const Eigen::Vector2d& point : points) {
    xs.push_back(point.x());
    ys.push_back(point.y());
  }
  return {upper_median(std::move(xs)), upper_median(std::move(ys))};
}

/// The finite points within the square of +-`half_side_m` about the median.
std::vector<Eigen::Vector2d> without_outliers(std::span<const Eigen::Vector2d> points,
                                              double half_side_m) {
  std::vector<Eigen::Vector2d> kept;
  std::copy_if(points.begin(), points.end(), std::back_inserter(kept),
               [](const Eigen::Vector2d& point) { return point.allFinite(); });
  if (kept.empty()) return kept;
  const Eigen::Vector2d centre = median(kept);
  std::erase_if(kept, [&](const Eigen::Vector2d& point) {
    return (point - centre).lpNorm<Eigen::Infinity>() > half_side_m;
  });
  return kept;
}

/// Squared distance of [low, high] from 0.
std::int64_t squared_gap(std::int64_t low, std::int64_t high) {
  const std::int64_t gap = std::max({low, -high, std::int64_t{0}});
  return gap * gap;
}

}  // namespace

CorrelativeField::CorrelativeField(std::span<const Eigen::Vector2d> points_in_submap,
                                   double resolution_m, double sigma_m)
    : frame_{.resolution_m = resolution_m} {
  assert(resolution_m > 0.0 && sigma_m > 0.0);
  const std::vector<Eigen::Vector2d> points =
      without_outliers(points_in_submap, kMaxHalfSide * resolution_m);
  if (points.empty()) return;
  draw(points, sigma_m);
  build_pyramid();
}

CorrelativeField CorrelativeField::of_map(std::span<const Eigen::Vector2d> points) {
  double resolution_m = kResolution_m;
  if (!points.empty()) {
    const Eigen::Vector2d centre = median(points);
    for (const Eigen::Vector2d& point : points) {
      const double off_m = (point - centre).lpNorm<Eigen::Infinity>();
      resolution_m = std::max(resolution_m, off_m / kMaxHalfSide);
    }
  }
  return CorrelativeField{points, resolution_m, resolution_m};
}

void CorrelativeField::draw(std::span<const Eigen::Vector2d> points, double sigma_m) {
  const double resolution_m = frame_.resolution_m;
  Eigen::Vector2d low = points.front();
  Eigen::Vector2d high = points.front();
  for (const Eigen::Vector2d& point : points) {
    low = low.cwiseMin(point);
    high = high.cwiseMax(point);
  }
  // A cell of the top level has the maximum of the 2^top cells from it upwards: the first one that
  // is not zero lies 2^top - 1 cells below the lowest drawn cell.
  const int reach = static_cast<int>(std::ceil(kSigmas * sigma_m / resolution_m));
  const int margin = reach + (1 << kTopLevel) - 1;
  // Cell centres at multiples of the resolution: walls there do not lie on cell borders.
  const Eigen::Vector2d low_cell = (low / resolution_m).array().round();
  frame_.origin_m = resolution_m * (low_cell.array() - 0.5 - margin).matrix();
  const CellIndex last = frame_.cell_of(high);
  width_ = last.x + 1 + reach;
  height_ = last.y + 1 + reach;

  const int side = 2 * reach + 1;
  std::vector<std::uint8_t> kernel;
  for (int cell = 0; cell < side * side; ++cell) {
    const double distance_m = resolution_m * std::hypot(cell % side - reach, cell / side - reach);
    const double exponent = -0.5 * std::pow(distance_m / sigma_m, 2);
    kernel.push_back(static_cast<std::uint8_t>(std::lround(kFull * std::exp(exponent))));
  }

  levels_.emplace_back(static_cast<std::size_t>(width_) * static_cast<std::size_t>(height_));
  std::uint8_t* const field = levels_.front().data();
  for (const Eigen::Vector2d& point : points) {
    const CellIndex cell = frame_.cell_of(point);
    if (field[cell.y * width_ + cell.x] == kFull) continue;  // drawn already
    for (int row = 0; row < side; ++row) {
      std::uint8_t* const to = field + (cell.y + row - reach) * width_ + cell.x - reach;
      const std::uint8_t* const from = kernel.data() + row * side;
      for (int x = 0; x < side; ++x)
        to[x] = std::max(to[x], from[x]);
    }
  }
}

void CorrelativeField::build_pyramid() {
  for (int level = 1; level <= kTopLevel; ++level) {
    const int step = 1 << (level - 1);
    std::vector<std::uint8_t> maxima = levels_.back();
    // In place, in ascending order: the cells ahead that are read are not yet written.
    for (int y = 0; y < height_; ++y) {
      std::uint8_t* const row = maxima.data() + y * width_;
      for (int x = 0; x < width_ - step; ++x)
        row[x] = std::max(row[x], row[x + step]);
    }
    for (int y = 0; y < height_ - step; ++y) {
      std::uint8_t* const row = maxima.data() + y * width_;
      const std::uint8_t* const above = row + step * width_;
      for (int x = 0; x < width_; ++x)
        row[x] = std::max(row[x], above[x]);
    }
    levels_.push_back(std::move(maxima));
  }
}

int CorrelativeField::sum(std::span<const CellIndex> cells, CellIndex offset, int level) const {
  const std::uint8_t* const values = levels_[static_cast<std::size_t>(level)].data();
  const auto width = static_cast<unsigned>(width_);
  const auto height = static_cast<unsigned>(height_);
  int total = 0;
  for (const CellIndex& cell : cells) {
    const auto x = static_cast<unsigned>(cell.x + offset.x);  // negative: huge
    const auto y = static_cast<unsigned>(cell.y + offset.y);
    if (x < width && y < height) total += values[y * width + x];
  }
  return total;
}

/// One branch-and-bound search. A node is a square of 2^level by 2^level offsets at one heading;
/// its bound is at least the score of any of them.
class CorrelativeField::Search {
 public:
  /// Excludes matches nearer to a pose than both limits.
  struct Excluded {
    Se2 pose{};
    double apart_m{0.0};
    double apart_rad{0.0};
  };

  Search(const CorrelativeField& field, std::span<const Eigen::Vector2d> points_in_base,
         const Se2& guess, const SearchWindow& window, const Excluded& excluded)
      : field_{field},
        guess_{guess},
        excluded_{excluded},
        full_sum_{static_cast<double>(kFull) * static_cast<double>(points_in_base.size())} {
    const double resolution_m = field.frame_.resolution_m;
    half_width_ = static_cast<int>(
        std::clamp(std::floor(window.half_width_m / resolution_m), 0.0, double{kMaxWindow}));
    const std::vector<Eigen::Vector2d> points = reachable(points_in_base);
    if (points.empty()) return;
    double farthest_m = resolution_m;
    for (const Eigen::Vector2d& point : points)
      farthest_m = std::max(farthest_m, point.norm());
    const double step_rad = std::max(resolution_m / farthest_m, kMinAngularStep_rad);
    const double half_turn_rad = std::clamp(window.half_turn_rad, 0.0, std::numbers::pi);
    const int steps = static_cast<int>(half_turn_rad / step_rad);
    for (int step = -steps; step <= steps; ++step)
      add_heading(points, step, step_rad);
  }

  std::optional<SearchMatch> run(double min_score) {
    best_.sum = std::max(1, static_cast<int>(std::ceil(min_score * full_sum_ - kRounding)));
    std::vector<Node> roots;
    for (const Heading& heading : headings_)
      add_roots(heading, roots);
    std::sort(roots.begin(), roots.end(), Node::is_before);
    for (const Node& root : roots)
      descend(root, top_level());
    if (!best_.heading) return {};
    return SearchMatch{pose(*best_.heading, best_.offset), best_.sum / full_sum_};
  }

 private:
  /// Rounding error of min_score * points * 255, so that a search with the score of a match finds
  /// that match.
  static constexpr double kRounding = 1e-6;

  /// The scan, rotated.
  struct Heading {
    int step{0};
    double theta_rad{0.0};
    bool is_excluded{false};  ///< turn within the limit: excluded where the shift is, too
    std::vector<CellIndex> cells{};
    CellIndex low{};  ///< first and last offset in the window at which a point can be in the field
    CellIndex high{};
  };

  struct Node {
    const Heading* heading{nullptr};
    CellIndex offset{};  ///< the lowest of its offsets
    int bound{0};
    std::int64_t cost{0};  ///< least squared distance from the guess, in cells and heading steps

    /// Best bound first; equal ones by distance from the guess, then by heading and offset.
    static bool is_before(const Node& a, const Node& b) {
      if (a.bound != b.bound) return a.bound > b.bound;
      if (a.cost != b.cost) return a.cost < b.cost;
      if (a.heading->step != b.heading->step) return a.heading->step < b.heading->step;
      if (a.offset.y != b.offset.y) return a.offset.y < b.offset.y;
      return a.offset.x < b.offset.x;
    }
  };

  struct Best {
    int sum{0};
    std::int64_t cost{std::numeric_limits<std::int64_t>::max()};
    const Heading* heading{nullptr};
    CellIndex offset{};
  };

  /// The points that can be in the field at some candidate; the others only cost time.
  std::vector<Eigen::Vector2d> reachable(std::span<const Eigen::Vector2d> points_in_base) const {
    if (field_.levels_.empty()) return {};
    const double resolution_m = field_.frame_.resolution_m;
    const Eigen::Vector2d half_size_m =
        0.5 * resolution_m * Eigen::Vector2d{field_.width_, field_.height_};
    const Eigen::Vector2d centre = field_.frame_.origin_m + half_size_m;
    const double reach_m = (guess_.translation() - centre).norm() + half_size_m.norm() +
                           std::numbers::sqrt2 * (half_width_ + 1) * resolution_m;
    std::vector<Eigen::Vector2d> points;
    for (const Eigen::Vector2d& point : points_in_base) {
      if (point.norm() <= reach_m) points.push_back(point);  // not if it is NaN
    }
    return points;
  }

  void add_heading(std::span<const Eigen::Vector2d> points, int step, double step_rad) {
    const Se2 turned{guess_.translation(), guess_.theta() + step * step_rad};
    Heading heading{.step = step, .theta_rad = turned.theta()};
    heading.is_excluded =
        std::abs(angle_difference(turned.theta(), excluded_.pose.theta())) < excluded_.apart_rad;
    CellIndex low{std::numeric_limits<int>::max(), std::numeric_limits<int>::max()};
    CellIndex high{std::numeric_limits<int>::min(), std::numeric_limits<int>::min()};
    const Eigen::Matrix2d rotation = turned.rotation();
    const GridFrame& frame = field_.frame_;
    for (const Eigen::Vector2d& point : points) {
      const Eigen::Vector2d position = rotation * point + turned.translation();
      const Eigen::Vector2d cells = ((position - frame.origin_m) / frame.resolution_m)
                                        .cwiseMax(-kFar_cells)
                                        .cwiseMin(kFar_cells);
      const CellIndex cell{static_cast<int>(std::floor(cells.x())),
                           static_cast<int>(std::floor(cells.y()))};
      heading.cells.push_back(cell);
      low = {std::min(low.x, cell.x), std::min(low.y, cell.y)};
      high = {std::max(high.x, cell.x), std::max(high.y, cell.y)};
    }
    heading.low = {std::max(-half_width_, -high.x), std::max(-half_width_, -high.y)};
    heading.high = {std::min(half_width_, field_.width_ - 1 - low.x),
                    std::min(half_width_, field_.height_ - 1 - low.y)};
    headings_.push_back(std::move(heading));
  }

  /// The lowest level at which one node covers the window, but at most kTopLevel.
  int top_level() const {
    int level = 0;
    while (level < kTopLevel && (1 << level) < 2 * half_width_ + 1)
      ++level;
    return level;
  }

  void add_roots(const Heading& heading, std::vector<Node>& roots) const {
    const int side = 1 << top_level();
    for (int y = heading.low.y; y <= heading.high.y; y += side) {
      for (int x = heading.low.x; x <= heading.high.x; x += side) {
        const Node root = node(heading, {x, y}, top_level());
        if (can_win(root)) roots.push_back(root);
      }
    }
  }

  Node node(const Heading& heading, CellIndex offset, int level) const {
    const CellIndex last = last_offset(heading, offset, level);
    if (is_excluded(heading, offset, last)) return {.heading = &heading};
    const std::int64_t turn = std::int64_t{heading.step} * heading.step;
    const std::int64_t cost = squared_gap(offset.x, last.x) + squared_gap(offset.y, last.y) + turn;
    return {&heading, offset, field_.sum(heading.cells, offset, level), cost};
  }

  static CellIndex last_offset(const Heading& heading, CellIndex offset, int level) {
    const int side = 1 << level;
    return {std::min(offset.x + side - 1, heading.high.x),
            std::min(offset.y + side - 1, heading.high.y)};
  }

  /// Whether all offsets from `first` to `last` are excluded: the disc is convex, so its corners.
  bool is_excluded(const Heading& heading, CellIndex first, CellIndex last) const {
    if (!heading.is_excluded) return false;
    const std::array corners{first, last, CellIndex{first.x, last.y}, CellIndex{last.x, first.y}};
    return std::all_of(corners.begin(), corners.end(), [&](CellIndex corner) {
      const Eigen::Vector2d gap =
          pose(heading, corner).translation() - excluded_.pose.translation();
      return gap.norm() < excluded_.apart_m;
    });
  }

  bool can_win(const Node& node) const {
    return node.bound > best_.sum || (node.bound == best_.sum && node.cost < best_.cost);
  }

  void descend(const Node& parent, int level) {
    if (!can_win(parent)) return;
    if (level == 0) {
      best_ = {parent.bound, parent.cost, parent.heading, parent.offset};
      return;
    }
    const Heading& heading = *parent.heading;
    const int half = 1 << (level - 1);
    std::array<Node, 4> children;
    children.fill({.heading = &heading});
    Node* next = children.data();
    for (int y = parent.offset.y; y <= parent.offset.y + half; y += half) {
      for (int x = parent.offset.x; x <= parent.offset.x + half; x += half) {
        if (y <= heading.high.y && x <= heading.high.x) *next++ = node(heading, {x, y}, level - 1);
      }
    }
    std::sort(children.begin(), children.end(), Node::is_before);
    for (const Node& child : children)
      descend(child, level - 1);
  }

  Se2 pose(const Heading& heading, CellIndex offset) const {
    const Eigen::Vector2d moved_m =
        field_.frame_.resolution_m * Eigen::Vector2d{offset.x, offset.y};
    return {guess_.translation() + moved_m, heading.theta_rad};
  }

  const CorrelativeField& field_;
  Se2 guess_{};
  Excluded excluded_{};
  double full_sum_{0.0};  ///< of a scan with every point in a cell of value 1
  int half_width_{0};     ///< cells
  std::vector<Heading> headings_{};
  Best best_{};
};

double CorrelativeField::score(std::span<const Eigen::Vector2d> points_in_base,
                               const Se2& submap_from_base) const {
  if (levels_.empty() || points_in_base.empty()) return 0.0;
  const Eigen::Matrix2d rotation = submap_from_base.rotation();
  std::int64_t total = 0;
  for (const Eigen::Vector2d& point : points_in_base) {
    const Eigen::Vector2d position = rotation * point + submap_from_base.translation();
    const Eigen::Vector2d cells = (position - frame_.origin_m) / frame_.resolution_m;
    const bool is_inside = cells.x() >= 0.0 && cells.x() < width_ && cells.y() >= 0.0 &&
                           cells.y() < height_;  // false if it is NaN
    if (is_inside) {
      total +=
          levels_.front()[static_cast<std::size_t>(cells.y()) * static_cast<std::size_t>(width_) +
                          static_cast<std::size_t>(cells.x())];
    }
  }
  return static_cast<double>(total) /
         (static_cast<double>(kFull) * static_cast<double>(points_in_base.size()));
}

std::optional<SearchMatch> CorrelativeField::best(std::span<const Eigen::Vector2d> points_in_base,
                                                  const Se2& guess, const SearchWindow& window,
                                                  double min_score) const {
  return Search{*this, points_in_base, guess, window, {}}.run(min_score);
}

std::optional<SearchMatch> CorrelativeField::best_apart_from(
    const Se2& other, double apart_m, double apart_rad,
    std::span<const Eigen::Vector2d> points_in_base, const Se2& guess, const SearchWindow& window,
    double min_score) const {
  return Search{*this, points_in_base, guess, window, {other, apart_m, apart_rad}}.run(min_score);
}

}  // namespace waymark

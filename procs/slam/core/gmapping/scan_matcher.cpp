// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/scan_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

/// Fixed in the released code: the free cell lies this far before the end of a beam, and a beam
/// without a hit nearby counts as if it were sqrt(0.5) m off.
constexpr double kFreeCellDistance_cells = std::numbers::sqrt2;
constexpr double kNoHit_m2 = 0.5;

/// Added to coordinates in cells so that truncation rounds down: without SSE4.1 std::floor is a
/// function call, which is too slow here. A power of two beyond every GridFrame; coordinates remain
/// exact to 3e-8 cells. Benchmark: tests/benchmark/gmapping_speed.cpp.
constexpr int kBias_cells = 1 << 27;

/// A pose of a climb, in whole numbers of the current step from the start.
struct LatticePoint {
  double x{0.0};
  double y{0.0};
  double turn{0.0};

  bool operator==(const LatticePoint&) const = default;

  LatticePoint operator+(const LatticePoint& other) const {
    return {x + other.x, y + other.y, turn + other.turn};
  }
};

constexpr std::array<LatticePoint, 6> kMoves{
    {{1, 0, 0}, {-1, 0, 0}, {0, -1, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, -1}}};

/// Just above the largest squared distance of a hit in the kernel from the end of a beam, the
/// diagonal.
double furthest_squared_cells2(int kernel_size) {
  return 2.01 * (kernel_size + 1) * (kernel_size + 1);
}

}  // namespace

/// From the base frame to the map, both in cells; those of the map are kBias_cells too large.
struct ScanMatcher::Transform {
  double cosine;
  double sine;
  double x;
  double y;

  Transform(const Se2& map_from_base, const GridFrame& frame)
      : cosine{std::cos(map_from_base.theta())},
        sine{std::sin(map_from_base.theta())},
        x{(map_from_base.x() - frame.origin_m.x()) / frame.resolution_m + kBias_cells},
        y{(map_from_base.y() - frame.origin_m.y()) / frame.resolution_m + kBias_cells} {}

  double x_of(double base_x, double base_y) const { return cosine * base_x - sine * base_y + x; }

  double y_of(double base_x, double base_y) const { return sine * base_x + cosine * base_y + y; }
};

MatcherSetting::MatcherSetting(const MatcherConfig& matcher_config, const GridFrame& grid_frame)
    : config{matcher_config},
      frame{grid_frame},
      score_of{config.sigma_m2 / (frame.resolution_m * frame.resolution_m),
               furthest_squared_cells2(config.kernel_size)} {}

ScanMatcher::ScanMatcher(const MatcherSetting& setting, const HitMap& map,
                         std::span<const Beam> beams)
    : setting_{setting},
      surroundings_{map, setting.config.kernel_size,
                    setting.config.free_cells == FreeCells::kIntended} {
  rays_.reserve(beams.size());
  for (const Beam& beam : beams) {
    if ((beam.index + 1) % (setting.config.skip_beams + 1) != 0) continue;
    const Eigen::Vector2d end = beam.end_in_base / setting.frame.resolution_m;
    const Eigen::Vector2d start = beam.start_in_base / setting.frame.resolution_m;
    const Eigen::Vector2d before = end - kFreeCellDistance_cells * (end - start).normalized();
    rays_.push_back({end.x(), end.y(), before.x(), before.y()});
  }
  num_rays_ = rays_.size();
  rays_.resize((num_rays_ + kAtOnce - 1) / kAtOnce * kAtOnce);
}

// Eight rays at once, so that the compiler vectorises. Benchmark:
// tests/benchmark/gmapping_speed.cpp.
ScanMatcher::Distances ScanMatcher::nearest(std::size_t first, const Transform& map_from_ray) {
  std::array<BeamCells, kAtOnce> cells{};
  std::array<float, kAtOnce> from_centre_x{};
  std::array<float, kAtOnce> from_centre_y{};
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    const Ray& ray = rays_[first + i];
    const double x = map_from_ray.x_of(ray.end_x, ray.end_y);
    const double y = map_from_ray.y_of(ray.end_x, ray.end_y);
    const int cell_x = static_cast<int>(x);
    const int cell_y = static_cast<int>(y);
    from_centre_x[i] = static_cast<float>(x - cell_x) - 0.5F;
    from_centre_y[i] = static_cast<float>(y - cell_y) - 0.5F;
    cells[i].end = {cell_x - kBias_cells, cell_y - kBias_cells};
  }
  if (setting_.config.free_cells == FreeCells::kIntended) {
    for (std::size_t i = 0; i < kAtOnce; ++i) {
      const Ray& ray = rays_[first + i];
      cells[i].before = {
          static_cast<int>(map_from_ray.x_of(ray.before_x, ray.before_y)) - kBias_cells,
          static_cast<int>(map_from_ray.y_of(ray.before_x, ray.before_y)) - kBias_cells};
    }
  }
  Distances distances{{}, std::min(kAtOnce, num_rays_ - first)};
  for (std::size_t i = 0; i < kAtOnce; ++i) {
    distances.squared[i] =
        surroundings_.nearest_squared(cells[i], from_centre_x[i], from_centre_y[i]);
  }
  return distances;
}

double ScanMatcher::score(const Se2& map_from_base, double to_beat) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  const auto highest = static_cast<double>(num_rays_);  // a beam adds 1 at most
  double lost = 0.0;
  for (std::size_t first = 0; first < num_rays_; first += kAtOnce) {
    for (const float squared : nearest(first, map_from_ray))
      lost += 1.0 - static_cast<double>(setting_.score_of(squared));
    if (highest - lost <= to_beat) break;
  }
  return highest - lost;
}

double ScanMatcher::log_likelihood(const Se2& map_from_base) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  const double cell_m2 = setting_.frame.resolution_m * setting_.frame.resolution_m;
  double sum_m2 = 0.0;
  for (std::size_t first = 0; first < num_rays_; first += kAtOnce) {
    for (const float squared : nearest(first, map_from_ray)) {
      sum_m2 += squared == Surroundings::kNothingAround ? kNoHit_m2
                                                        : cell_m2 * static_cast<double>(squared);
    }
  }
  return -sum_m2 / setting_.config.likelihood_sigma_m2;
}

void ScanMatcher::worst_first(const Se2& map_from_base) {
  struct Ranked {
    float squared;
    Ray ray;
  };

  const Transform map_from_ray{map_from_base, setting_.frame};
  std::vector<Ranked> ranked;
  ranked.reserve(rays_.size());
  for (std::size_t first = 0; first < num_rays_; first += kAtOnce) {
    for (const float squared : nearest(first, map_from_ray))
      ranked.push_back({squared, rays_[ranked.size()]});
  }
  std::stable_sort(ranked.begin(), ranked.end(),
                   [](const Ranked& a, const Ranked& b) { return a.squared > b.squared; });
  std::transform(ranked.begin(), ranked.end(), rays_.begin(),
                 [](const Ranked& each) { return each.ray; });
}

ScanMatcher::Match ScanMatcher::climb(const Se2& start) {
  worst_first(start);
  Match best{start, score(start)};
  double step_m = setting_.config.linear_step_m;
  double turn_rad = setting_.config.angular_step_rad;
  LatticePoint best_point{};
  std::vector<LatticePoint> seen{best_point};
  // A pose that was evaluated before, on whatever path, scored no more than the best one.
  const auto is_new = [&](const LatticePoint& point) {
    if (std::find(seen.begin(), seen.end(), point) != seen.end()) return false;
    seen.push_back(point);
    return true;
  };
  for (int halvings = 0; halvings <= setting_.config.iterations;) {
    const Match centre = best;
    const LatticePoint centre_point = best_point;
    for (const LatticePoint& move : kMoves) {
      const LatticePoint point = centre_point + move;
      if (!is_new(point)) continue;
      const Se2 moved{centre.map_from_base.x() + move.x * step_m,
                      centre.map_from_base.y() + move.y * step_m,
                      centre.map_from_base.theta() + move.turn * turn_rad};
      const double moved_score = score(moved, best.score);
      if (moved_score <= best.score) continue;
      best = {moved, moved_score};
      best_point = point;
    }
    if (best.score > centre.score) continue;
    step_m *= 0.5;
    turn_rad *= 0.5;
    ++halvings;
    best_point = best_point + best_point;
    for (LatticePoint& point : seen)
      point = point + point;
  }
  return best;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/gmapping/scan_matcher.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

/// Fixed in the released code: the free cell lies this far before the end of a beam, and a beam
/// with no hit around counts as if it were sqrt(0.5) m off.
constexpr double kFreeCellDistance_cells = std::numbers::sqrt2;
constexpr double kNoHit_m2 = 0.5;

/// Added to coordinates in cells so that truncating them rounds down: without SSE4.1 std::floor is
/// a function call, which the matcher cannot afford. A power of two beyond every GridFrame; it
/// leaves coordinates exact to 1e-8 cells. tests/benchmark/gmapping_speed.cpp
constexpr int kBias_cells = 1 << 27;

constexpr std::size_t kNoMove = 6;  // one past the six moves of a climb

/// Beyond what a hit in the kernel can be from the end of a beam, which is corner to corner.
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
    rays_.push_back({end.x(), end.y(), before.x(), before.y(), 0.0F});
  }
}

/// Squared distance [cells^2] from the ray's end to the nearest hit around.
inline float ScanMatcher::nearest_squared(const Ray& ray, const Transform& map_from_ray) {
  const double x = map_from_ray.x_of(ray.end_x, ray.end_y);
  const double y = map_from_ray.y_of(ray.end_x, ray.end_y);
  const int cell_x = static_cast<int>(x);
  const int cell_y = static_cast<int>(y);
  BeamCells cells{{cell_x - kBias_cells, cell_y - kBias_cells}, {}};
  if (setting_.config.free_cells == FreeCells::kIntended) {
    cells.before = {static_cast<int>(map_from_ray.x_of(ray.before_x, ray.before_y)) - kBias_cells,
                    static_cast<int>(map_from_ray.y_of(ray.before_x, ray.before_y)) - kBias_cells};
  }
  return surroundings_.nearest_squared(cells, static_cast<float>(x - cell_x) - 0.5F,
                                       static_cast<float>(y - cell_y) - 0.5F);
}

double ScanMatcher::score(const Se2& map_from_base, double to_beat) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  double score = 0.0;
  auto can_add = static_cast<double>(rays_.size());  // a beam adds 1 at most
  for (const Ray& ray : rays_) {
    score += static_cast<double>(setting_.score_of(nearest_squared(ray, map_from_ray)));
    can_add -= 1.0;
    if (score + can_add <= to_beat) return score;
  }
  return score;
}

double ScanMatcher::log_likelihood(const Se2& map_from_base) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  const double cell_m2 = setting_.frame.resolution_m * setting_.frame.resolution_m;
  double sum_m2 = 0.0;
  for (const Ray& ray : rays_) {
    const float squared = nearest_squared(ray, map_from_ray);
    sum_m2 += squared == Surroundings::kNothingAround ? kNoHit_m2
                                                      : cell_m2 * static_cast<double>(squared);
  }
  return -sum_m2 / setting_.config.likelihood_sigma_m2;
}

void ScanMatcher::worst_first(const Se2& map_from_base) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  for (Ray& ray : rays_)
    ray.rank = nearest_squared(ray, map_from_ray);
  std::stable_sort(rays_.begin(), rays_.end(),
                   [](const Ray& a, const Ray& b) { return a.rank > b.rank; });
}

ScanMatcher::Match ScanMatcher::climb(const Se2& start) {
  worst_first(start);
  Match best{start, score(start)};
  double step_m = setting_.config.linear_step_m;
  double turn_rad = setting_.config.angular_step_rad;
  std::size_t way_back = kNoMove;
  for (int halvings = 0; halvings <= setting_.config.iterations;) {
    const Se2 centre = best.map_from_base;
    // Opposite moves stand side by side.
    const std::array<Se2, 6> moves{Se2{centre.x() + step_m, centre.y(), centre.theta()},
                                   Se2{centre.x() - step_m, centre.y(), centre.theta()},
                                   Se2{centre.x(), centre.y() - step_m, centre.theta()},
                                   Se2{centre.x(), centre.y() + step_m, centre.theta()},
                                   Se2{centre.x(), centre.y(), centre.theta() + turn_rad},
                                   Se2{centre.x(), centre.y(), centre.theta() - turn_rad}};
    std::size_t best_move = kNoMove;
    for (std::size_t move = 0; move < moves.size(); ++move) {
      if (move == way_back) continue;  // where it came from scored less
      const double moved_score = score(moves[move], best.score);
      if (moved_score <= best.score) continue;
      best = {moves[move], moved_score};
      best_move = move;
    }
    way_back = best_move == kNoMove ? kNoMove : best_move ^ 1U;
    if (best_move != kNoMove) continue;
    step_m *= 0.5;
    turn_rad *= 0.5;
    ++halvings;
  }
  return best;
}

}  // namespace waymark

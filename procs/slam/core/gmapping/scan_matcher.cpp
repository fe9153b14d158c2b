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

/// Without SSE4.1 std::floor is a function call; this loop cannot afford one.
/// tests/benchmark/gmapping_speed.cpp
int floor_to_int(double value) {
  const int truncated = static_cast<int>(value);
  return truncated - (value < truncated ? 1 : 0);
}

/// Furthest that a hit in the kernel can be from the end of a beam: corner to corner.
double furthest_squared_cells2(int kernel_size) {
  return 2.0 * (kernel_size + 1) * (kernel_size + 1);
}

}  // namespace

/// From the base frame to the map, both in cells.
struct ScanMatcher::Transform {
  double cosine;
  double sine;
  double x;
  double y;

  Transform(const Se2& map_from_base, const GridFrame& frame)
      : cosine{std::cos(map_from_base.theta())},
        sine{std::sin(map_from_base.theta())},
        x{(map_from_base.x() - frame.origin_m.x()) / frame.resolution_m},
        y{(map_from_base.y() - frame.origin_m.y()) / frame.resolution_m} {}

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
}

/// Squared distance [cells^2] from the ray's end to the nearest hit around.
float ScanMatcher::nearest_squared(const Ray& ray, const Transform& map_from_ray) {
  const double x = map_from_ray.x_of(ray.end_x, ray.end_y);
  const double y = map_from_ray.y_of(ray.end_x, ray.end_y);
  BeamCells cells{{floor_to_int(x), floor_to_int(y)}, {}};
  if (setting_.config.free_cells == FreeCells::kIntended) {
    cells.before = {floor_to_int(map_from_ray.x_of(ray.before_x, ray.before_y)),
                    floor_to_int(map_from_ray.y_of(ray.before_x, ray.before_y))};
  }
  return surroundings_.nearest_squared(cells, static_cast<float>(x - cells.end.x - 0.5),
                                       static_cast<float>(y - cells.end.y - 0.5));
}

double ScanMatcher::score(const Se2& map_from_base, double to_beat) {
  const Transform map_from_ray{map_from_base, setting_.frame};
  double score = 0.0;
  auto can_add = static_cast<double>(rays_.size());  // a beam adds 1 at most
  for (const Ray& ray : rays_) {
    const float squared = nearest_squared(ray, map_from_ray);
    if (squared != Surroundings::kNothingAround)
      score += static_cast<double>(setting_.score_of(squared));
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

ScanMatcher::Match ScanMatcher::climb(const Se2& start) {
  Match best{start, score(start)};
  double step_m = setting_.config.linear_step_m;
  double turn_rad = setting_.config.angular_step_rad;
  for (int halvings = 0; halvings <= setting_.config.iterations;) {
    const Se2 centre = best.map_from_base;
    const std::array<Se2, 6> moves{Se2{centre.x() + step_m, centre.y(), centre.theta()},
                                   Se2{centre.x() - step_m, centre.y(), centre.theta()},
                                   Se2{centre.x(), centre.y() - step_m, centre.theta()},
                                   Se2{centre.x(), centre.y() + step_m, centre.theta()},
                                   Se2{centre.x(), centre.y(), centre.theta() + turn_rad},
                                   Se2{centre.x(), centre.y(), centre.theta() - turn_rad}};
    bool has_improved = false;
    for (const Se2& moved : moves) {
      const double moved_score = score(moved, best.score);
      if (moved_score <= best.score) continue;
      best = {moved, moved_score};
      has_improved = true;
    }
    if (has_improved) continue;
    step_m *= 0.5;
    turn_rad *= 0.5;
    ++halvings;
  }
  return best;
}

}  // namespace waymark

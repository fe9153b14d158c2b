// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/motion/hand_eye.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr std::size_t kFewest = 30;
constexpr double kFewestTurns_rad = 2.0 * std::numbers::pi;
constexpr double kLargestOffset_s = 0.5;
constexpr double kParabola_s = 0.1;            // half its width: turns of a robot last longer
constexpr double kShortestInterval_s = 0.005;  // of odometry: shorter ones are taken together
constexpr double kSigmaOfMad = 1.4826;         // of a normal distribution
constexpr double kCutoff = 3.0;                // of the sigmas: what is further counts less
constexpr double kSmallest = 1e-9;
constexpr double kUnknownPlace_m = 1.0;  // a robot's size
constexpr std::size_t kBlocks = 12;      // stretches whose residuals count as one each

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::ranges::nth_element(values, middle);
  return *middle;
}

bool covers(const std::vector<ImportedPose>& odometry, Timestamp from, Timestamp to) {
  return from >= odometry.front().time && to <= odometry.back().time;
}

/// Turns of both, one entry per pair of scans.
struct Turns {
  std::vector<double> lidar_rad{};
  std::vector<double> odometry_rad{};
};

Turns turns_with(const std::vector<LidarTurn>& turns, const std::vector<ImportedPose>& odometry,
                 double late_s) {
  const Duration late = duration_from_seconds(late_s);
  Turns both;
  for (const LidarTurn& turn : turns) {
    if (!covers(odometry, turn.from - late, turn.to - late)) continue;
    const Se2 from = pose_at(odometry, turn.from - late);
    const Se2 to = pose_at(odometry, turn.to - late);
    both.lidar_rad.push_back(turn.turn_rad);
    both.odometry_rad.push_back(angle_difference(to.theta(), from.theta()));
  }
  return both;
}

/// odometry = ratio * lidar, robust.
struct Line {
  double ratio{0.0};
  double ratio_sigma{0.0};
  double cost{0.0};                             ///< mean of Cauchy's loss over its square cutoff
  std::array<double, kBlocks> cost_of_block{};  ///< sums
  std::array<double, kBlocks> turns_of_block{};

  /// Mean without one block; kBlocks = with all.
  double cost_without(std::size_t block) const {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t other = 0; other < kBlocks; ++other) {
      if (other == block) continue;
      sum += cost_of_block[other];
      count += turns_of_block[other];
    }
    return sum / std::max(1.0, count);
  }
};

double weight_of(double residual, double cutoff) {
  const double relative = residual / cutoff;
  return 1.0 / (1.0 + relative * relative);
}

std::optional<Line> fit_line(const Turns& turns, double cutoff_rad) {
  if (turns.lidar_rad.size() < kFewest) return std::nullopt;
  Line line;
  // Both signs are tried first: a robust fit from the wrong one may stay there.
  double best = 0.0;
  for (const double start : {1.0, -1.0}) {
    double ratio = start;
    double information = 0.0;
    double squares = 0.0;
    double weights = 0.0;
    constexpr int kSteps = 20;
    for (int step = 0; step < kSteps; ++step) {
      double product = 0.0;
      information = squares = weights = 0.0;
      for (std::size_t i = 0; i < turns.lidar_rad.size(); ++i) {
        const double lidar_rad = turns.lidar_rad[i];
        const double residual = turns.odometry_rad[i] - ratio * lidar_rad;
        const double weight = weight_of(residual, cutoff_rad);
        product += weight * lidar_rad * turns.odometry_rad[i];
        information += weight * lidar_rad * lidar_rad;
        squares += weight * residual * residual;
        weights += weight;
      }
      if (information < kSmallest) return std::nullopt;
      ratio = product / information;
    }
    Line fitted{ratio, std::sqrt(squares / weights / information)};
    const std::size_t count = turns.lidar_rad.size();
    for (std::size_t i = 0; i < count; ++i) {
      const double relative = (turns.odometry_rad[i] - ratio * turns.lidar_rad[i]) / cutoff_rad;
      const std::size_t block = i * kBlocks / count;
      fitted.cost_of_block[block] += std::log1p(relative * relative);
      fitted.turns_of_block[block] += 1.0;
    }
    fitted.cost = fitted.cost_without(kBlocks);
    if (start > 0.0 || fitted.cost < best) {
      best = fitted.cost;
      line = fitted;
    }
  }
  return line;
}

/// At an offset and half a width before and after it; where is the least, in half widths?
struct CostsAroundBest {
  double before{0.0};
  double at{0.0};
  double after{0.0};

  double parabola() const {
    const double bend = before - 2.0 * at + after;
    return bend > kSmallest ? 0.5 * (before - after) / bend : 0.0;
  }

  /// Of two straight lines of the same steepness. A robust loss has the one shape near its least
  /// and the other one further off, so that the truth lies between the two.
  double wedge() const {
    const double rise = std::max(before, after) - at;
    return rise > kSmallest ? 0.5 * (before - after) / rise : 0.0;
  }
};

double median_interval_s(const std::vector<ImportedPose>& odometry) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    intervals_s.push_back(to_seconds(odometry[i].time - odometry[i - 1].time));
  return std::max(kShortestInterval_s, median(std::move(intervals_s)));
}

/// Of odometry that is too seldom to look for one.
std::optional<TurnComparison> comparison_without_offset(TurnComparison comparison, const Turns& now,
                                                        double cutoff_rad) {
  const auto line = fit_line(now, cutoff_rad);
  if (!line) return std::nullopt;
  comparison.ratio = {line->ratio, line->ratio_sigma};
  comparison.lidar_late_s = {0.0, kLargestOffset_s};
  return comparison;
}

}  // namespace

std::optional<TurnComparison> compare_turns(const std::vector<LidarTurn>& turns,
                                            const std::vector<ImportedPose>& odometry) {
  TurnComparison comparison;
  std::vector<double> sizes_rad;
  for (const LidarTurn& turn : turns) {
    comparison.turned_rad += std::abs(turn.turn_rad);
    sizes_rad.push_back(std::abs(turn.turn_rad));
  }
  if (turns.size() < kFewest || comparison.turned_rad < kFewestTurns_rad) return std::nullopt;
  // A cutoff from the residuals of the best line without an offset; at least a tenth of a degree.
  const Turns now = turns_with(turns, odometry, 0.0);
  constexpr double kFloor_rad = 0.0017;
  double cutoff_rad = 0.1;
  for (int i = 0; i < 3; ++i) {
    const auto line = fit_line(now, cutoff_rad);
    if (!line) return std::nullopt;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < now.lidar_rad.size(); ++k)
      residuals.push_back(std::abs(now.odometry_rad[k] - line->ratio * now.lidar_rad[k]));
    cutoff_rad = kCutoff * std::max(kFloor_rad, kSigmaOfMad * median(std::move(residuals)));
  }
  // Offsets of whole odometry samples: between them odometry is interpolated, which smooths its
  // noise and makes every fit better.
  const double interval_s = median_interval_s(odometry);
  const int steps = static_cast<int>(std::floor(kLargestOffset_s / interval_s));
  if (steps < 1) return comparison_without_offset(comparison, now, cutoff_rad);
  std::vector<Line> lines;
  std::size_t best = 0;
  for (int i = -steps; i <= steps; ++i) {
    const auto line = fit_line(turns_with(turns, odometry, i * interval_s), cutoff_rad);
    if (!line) return std::nullopt;
    lines.push_back(*line);
    if (line->cost < lines[best].cost) best = lines.size() - 1;
  }
  comparison.ratio = {lines[best].ratio, lines[best].ratio_sigma};
  comparison.lidar_late_s = {(static_cast<double>(best) - steps) * interval_s, kLargestOffset_s};
  const auto wide = static_cast<std::size_t>(std::max(1.0, std::round(kParabola_s / interval_s)));
  if (best < wide || best + wide >= lines.size()) return comparison;  // nothing is known there
  const double half_width_s = static_cast<double>(wide) * interval_s;
  const auto costs = [&](std::size_t without) {
    return CostsAroundBest{lines[best - wide].cost_without(without),
                           lines[best].cost_without(without),
                           lines[best + wide].cost_without(without)};
  };
  // How much it moves without each stretch (jackknife).
  const double vertex = half_width_s * costs(kBlocks).parabola();
  double variance_s2 = 0.0;
  for (std::size_t block = 0; block < kBlocks; ++block) {
    const double moved_s = half_width_s * costs(block).parabola() - vertex;
    variance_s2 += moved_s * moved_s;
  }
  // And with the shape that is laid through the three costs: the same in every stretch.
  const double shape_s = half_width_s * costs(kBlocks).wedge() - vertex;
  variance_s2 += shape_s * shape_s;
  comparison.lidar_late_s.value += vertex;
  comparison.lidar_late_s.sigma = std::sqrt(variance_s2);
  if (const auto line =
          fit_line(turns_with(turns, odometry, comparison.lidar_late_s.value), cutoff_rad)) {
    comparison.ratio = {line->ratio, line->ratio_sigma};
  }
  return comparison;
}

std::optional<HandEye> hand_eye(const std::vector<LidarMotion>& motions,
                                const std::vector<ImportedPose>& odometry, bool is_mirrored,
                                Duration lidar_late) {
  double turned_rad = 0.0;
  std::vector<Eigen::Matrix<double, 2, 4>> rows;
  std::vector<Eigen::Vector2d> values;
  for (const LidarMotion& motion : motions) {
    const Timestamp from = motion.from - lidar_late;
    const Timestamp to = motion.to - lidar_late;
    if (!motion.is_complete || !covers(odometry, from, to)) continue;
    const Se2 base = pose_at(odometry, from).inverse() * pose_at(odometry, to);
    const Eigen::Vector2d lidar{motion.first_from_second.x(),
                                (is_mirrored ? -1.0 : 1.0) * motion.first_from_second.y()};
    const double c = std::cos(base.theta());
    const double s = std::sin(base.theta());
    Eigen::Matrix<double, 2, 4> row;
    row << lidar.x(), -lidar.y(), 1.0 - c, s, lidar.y(), lidar.x(), -s, 1.0 - c;
    rows.push_back(row);
    turned_rad += std::abs(wrap_angle(motion.first_from_second.theta()));
    values.push_back(base.translation());
  }
  if (rows.size() < kFewest) return std::nullopt;

  Eigen::Vector4d found = Eigen::Vector4d::Zero();
  Eigen::Matrix4d information = Eigen::Matrix4d::Zero();
  double cutoff_m = 1e3;  // first all alike
  double sigma2_m2 = 0.0;
  constexpr int kSteps = 30;
  for (int step = 0; step < kSteps; ++step) {
    information.setZero();
    Eigen::Vector4d product = Eigen::Vector4d::Zero();
    double squares = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double residual_m = (values[i] - rows[i] * found).norm();
      const double weight = step == 0 ? 1.0 : weight_of(residual_m, cutoff_m);
      information += weight * rows[i].transpose() * rows[i];
      product += weight * rows[i].transpose() * values[i];
      squares += weight * residual_m * residual_m;
      weights += weight;
    }
    const Eigen::LDLT<Eigen::Matrix4d> solver{information};
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    found = solver.solve(product);
    if (!found.allFinite()) return std::nullopt;
    std::vector<double> residuals_m;
    for (std::size_t i = 0; i < rows.size(); ++i)
      residuals_m.push_back((values[i] - rows[i] * found).norm());
    cutoff_m = kCutoff * std::max(1e-4, median(std::move(residuals_m)));
    sigma2_m2 = step == 0 ? cutoff_m * cutoff_m : 0.5 * squares / weights;
  }
  const Eigen::Matrix4d inverse = (information + kSmallest * Eigen::Matrix4d::Identity()).inverse();
  // What wheels and walls get wrong lasts: motions of a stretch err together.
  Eigen::Matrix4d spread = Eigen::Matrix4d::Zero();
  for (std::size_t block = 0; block < kBlocks; ++block) {
    Eigen::Vector4d slope = Eigen::Vector4d::Zero();
    for (std::size_t i = block * rows.size() / kBlocks; i < (block + 1) * rows.size() / kBlocks;
         ++i) {
      const Eigen::Vector2d residual_m = values[i] - rows[i] * found;
      slope += weight_of(residual_m.norm(), cutoff_m) * rows[i].transpose() * residual_m;
    }
    spread += slope * slope.transpose();
  }
  const Eigen::Matrix4d covariance =
      (sigma2_m2 * inverse).cwiseMax(inverse * spread * inverse).eval();
  const double scale = std::hypot(found[0], found[1]);
  if (scale < kSmallest) return std::nullopt;
  const auto sigma = [&](int i) {
    return std::sqrt(covariance(i, i));
  };
  // Without turns only odometry's noise distinguishes a lever from none.
  const double least_sigma_m = turned_rad < kFewestTurns_rad ? kUnknownPlace_m : 0.0;
  const double sigma_direction = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
  return HandEye{{found[2] / scale, std::max(least_sigma_m, sigma(2) / scale)},
                 {found[3] / scale, std::max(least_sigma_m, sigma(3) / scale)},
                 {std::atan2(found[1], found[0]), sigma_direction / scale},
                 {scale, sigma_direction},
                 static_cast<int>(rows.size())};
}

}  // namespace waymark

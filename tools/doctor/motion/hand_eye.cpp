// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/motion/hand_eye.hpp"

#include "common/geometry/median.hpp"
#include "doctor/motion/far_offset.hpp"

#include <Eigen/Dense>

#include <algorithm>
#include <cmath>
#include <numbers>

namespace waymark {
namespace {

constexpr std::size_t kMinMotions = 30;
constexpr double kMinTurned_rad = 2.0 * std::numbers::pi;
constexpr double kMaxOffset_s = 0.5;
constexpr double kRateOver_s = 0.2;  // window in which turn rates are averaged; turns last longer
// d(remaining offset) / d(offset): 1 without noise; below this the offset is not observable.
constexpr double kMinSlope = 0.05;
constexpr double kMinInterval_s = 0.005;     // step of the search if odometry's interval is shorter
constexpr double kCutoff = 3.0;              // kernel width of the robust weights, in sigmas
constexpr double kMinResidual_rad = 0.0017;  // a tenth of a degree
constexpr double kMinResidual_m = 1e-4;
constexpr double kSmallest = 1e-9;
constexpr double kUnknownPlace_m = 1.0;  // sigma of an unobserved position: a robot's size
constexpr std::size_t kBlocks = 12;      // parts of the log that count as independent
constexpr double kSignificant = 3.0;     // [sigma]
// Least correlation of consecutive turns that are no noise: real turns have 0.9 at 10 scans a
// second.
constexpr double kMinPersistence = 0.3;

bool covers(const std::vector<ImportedPose>& odometry, Timestamp from, Timestamp to) {
  return from >= odometry.front().time && to <= odometry.back().time;
}

/// Turns of LiDAR and odometry, one entry per pair of scans.
struct Turns {
  std::vector<Timestamp> from{};  ///< start of the turn on odometry's clock
  std::vector<Timestamp> to{};
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
    both.from.push_back(turn.from - late);
    both.to.push_back(turn.to - late);
    both.lidar_rad.push_back(turn.turn_rad);
    both.odometry_rad.push_back(angle_difference(to.theta(), from.theta()));
  }
  return both;
}

/// Robust fit of odometry = ratio * lidar.
struct Line {
  double ratio{0.0};
  double ratio_sigma{0.0};
  double cost{0.0};  ///< mean of log(1 + (residual / cutoff)^2): Cauchy's loss
};

double weight_of(double residual, double cutoff) {
  const double relative = residual / cutoff;
  return 1.0 / (1.0 + relative * relative);
}

std::optional<Line> fit_line(const Turns& turns, double cutoff_rad) {
  if (turns.lidar_rad.size() < kMinMotions) return std::nullopt;
  Line line;
  // Starts from both signs: a robust fit may not leave the wrong sign.
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
    for (std::size_t i = 0; i < turns.lidar_rad.size(); ++i) {
      const double relative = (turns.odometry_rad[i] - ratio * turns.lidar_rad[i]) / cutoff_rad;
      fitted.cost += std::log1p(relative * relative);
    }
    fitted.cost /= static_cast<double>(turns.lidar_rad.size());
    if (start > 0.0 || fitted.cost < best) {
      best = fitted.cost;
      line = fitted;
    }
  }
  return line;
}

/// Turn rate over a window that is long enough to average out noise.
double turn_rate_rad_s(const std::vector<ImportedPose>& odometry, Timestamp time) {
  const Duration half = duration_from_seconds(0.5 * kRateOver_s);
  const Se2 before = pose_at(odometry, std::max(odometry.front().time, time - half));
  const Se2 after = pose_at(odometry, std::min(odometry.back().time, time + half));
  return angle_difference(after.theta(), before.theta()) / kRateOver_s;
}

/// Linear equations: values = rows * unknowns + noise.
template <int kRows, int kUnknowns>
struct Equations {
  std::vector<Eigen::Matrix<double, kRows, kUnknowns>> rows{};
  std::vector<Eigen::Matrix<double, kRows, 1>> values{};
};

template <int kUnknowns>
struct Solution {
  Eigen::Matrix<double, kUnknowns, 1> unknowns{};
  Eigen::Matrix<double, kUnknowns, kUnknowns> covariance{};
};

/// Robust least squares (Cauchy's weights, cutoff from the median residual). Errors of wheels and
/// walls are correlated in time: the covariance is a sandwich estimate with kBlocks parts of the
/// log as clusters, but not below that of independent equations.
/// @param least_residual  lower bound of the median residual.
template <int kRows, int kUnknowns>
std::optional<Solution<kUnknowns>> solve_robustly(const Equations<kRows, kUnknowns>& equations,
                                                  double least_residual) {
  using Square = Eigen::Matrix<double, kUnknowns, kUnknowns>;
  using Column = Eigen::Matrix<double, kUnknowns, 1>;
  const auto& [rows, values] = equations;
  Column found = Column::Zero();
  Square information = Square::Zero();
  double cutoff = 0.0;
  double sigma2 = 0.0;
  constexpr int kSteps = 30;
  for (int step = 0; step < kSteps; ++step) {
    information.setZero();
    Column product = Column::Zero();
    double squares = 0.0;
    double weights = 0.0;
    for (std::size_t i = 0; i < rows.size(); ++i) {
      const double residual = (values[i] - rows[i] * found).norm();
      const double weight = step == 0 ? 1.0 : weight_of(residual, cutoff);
      information += weight * rows[i].transpose() * rows[i];
      product += weight * rows[i].transpose() * values[i];
      squares += weight * residual * residual;
      weights += weight;
    }
    const Eigen::LDLT<Square> solver{information};
    if (solver.info() != Eigen::Success || !solver.isPositive()) return std::nullopt;
    found = solver.solve(product);
    if (!found.allFinite()) return std::nullopt;
    std::vector<double> residuals;
    for (std::size_t i = 0; i < rows.size(); ++i)
      residuals.push_back((values[i] - rows[i] * found).norm());
    cutoff = kCutoff * std::max(least_residual, upper_median(std::move(residuals)));
    sigma2 = squares / weights / kRows;
  }
  const Square inverse = (information + kSmallest * Square::Identity()).inverse();
  Square spread = Square::Zero();
  for (std::size_t block = 0; block < kBlocks; ++block) {
    Column slope = Column::Zero();
    for (std::size_t i = block * rows.size() / kBlocks; i < (block + 1) * rows.size() / kBlocks;
         ++i) {
      const Eigen::Matrix<double, kRows, 1> residual = values[i] - rows[i] * found;
      slope += weight_of(residual.norm(), cutoff) * rows[i].transpose() * residual;
    }
    spread += slope * slope.transpose();
  }
  return Solution<kUnknowns>{found, (sigma2 * inverse).cwiseMax(inverse * spread * inverse).eval()};
}

/// The time offset that remains after correcting by `late_s`: an offset changes a turn of the
/// odometry by the offset times the difference of the turn rates at its ends.
std::optional<Measured> remaining_offset_s(const std::vector<LidarTurn>& turns,
                                           const std::vector<ImportedPose>& odometry,
                                           double late_s) {
  const Turns both = turns_with(turns, odometry, late_s);
  Equations<1, 2> equations;
  for (std::size_t i = 0; i < both.lidar_rad.size(); ++i) {
    equations.rows.emplace_back(both.lidar_rad[i], turn_rate_rad_s(odometry, both.to[i]) -
                                                       turn_rate_rad_s(odometry, both.from[i]));
    equations.values.emplace_back(both.odometry_rad[i]);
  }
  if (equations.rows.size() < kMinMotions) return std::nullopt;
  const auto solution = solve_robustly(equations, kMinResidual_rad);
  if (!solution) return std::nullopt;
  return Measured{solution->unknowns[1], std::sqrt(solution->covariance(1, 1))};
}

double median_interval_s(const std::vector<ImportedPose>& odometry) {
  std::vector<double> intervals_s;
  for (std::size_t i = 1; i < odometry.size(); ++i)
    intervals_s.push_back(to_seconds(odometry[i].time - odometry[i - 1].time));
  return std::max(kMinInterval_s, upper_median(std::move(intervals_s)));
}

/// Result for odometry too infrequent to search for an offset: 0 with a sigma of kMaxOffset_s.
std::optional<TurnComparison> comparison_without_offset(TurnComparison comparison, const Turns& now,
                                                        double cutoff_rad) {
  const auto line = fit_line(now, cutoff_rad);
  if (!line) return std::nullopt;
  comparison.ratio = {line->ratio, line->ratio_sigma};
  comparison.lidar_late_s = {0.0, kMaxOffset_s};
  return comparison;
}

/// compare_turns() without far_late_s.
std::optional<TurnComparison> compare_near(const std::vector<LidarTurn>& turns,
                                           const std::vector<ImportedPose>& odometry) {
  TurnComparison comparison;
  comparison.persistence = persistence_of(turns);
  std::vector<double> sizes_rad;
  for (const LidarTurn& turn : turns) {
    comparison.turned_rad += std::abs(turn.turn_rad);
    sizes_rad.push_back(std::abs(turn.turn_rad));
  }
  if (turns.size() < kMinMotions || comparison.turned_rad < kMinTurned_rad) return std::nullopt;
  // Cutoff from the residuals of the best line without an offset.
  const Turns now = turns_with(turns, odometry, 0.0);
  double cutoff_rad = 0.1;
  for (int i = 0; i < 3; ++i) {
    const auto line = fit_line(now, cutoff_rad);
    if (!line) return std::nullopt;
    std::vector<double> residuals;
    for (std::size_t k = 0; k < now.lidar_rad.size(); ++k)
      residuals.push_back(std::abs(now.odometry_rad[k] - line->ratio * now.lidar_rad[k]));
    cutoff_rad =
        kCutoff * std::max(kMinResidual_rad, kSigmaOfMad * upper_median(std::move(residuals)));
  }
  // Only offsets of whole odometry intervals: at other offsets odometry is interpolated, which
  // smooths its noise and makes the fit better than at the true offset.
  const double interval_s = median_interval_s(odometry);
  const int steps = static_cast<int>(std::floor(kMaxOffset_s / interval_s));
  if (steps < 1) return comparison_without_offset(comparison, now, cutoff_rad);
  std::vector<Line> lines;
  std::size_t best = 0;
  for (int i = -steps; i <= steps; ++i) {
    const auto line = fit_line(turns_with(turns, odometry, i * interval_s), cutoff_rad);
    if (!line) return std::nullopt;
    lines.push_back(*line);
    if (line->cost < lines[best].cost) best = lines.size() - 1;
  }
  const double late_s = (static_cast<double>(best) - steps) * interval_s;
  comparison.ratio = {lines[best].ratio, lines[best].ratio_sigma};
  comparison.lidar_late_s = {late_s, kMaxOffset_s};
  const auto beside =
      static_cast<std::size_t>(std::max(1.0, std::round(0.5 * kRateOver_s / interval_s)));
  if (best < beside || best + beside >= lines.size()) return comparison;
  const double half_width_s = static_cast<double>(beside) * interval_s;
  const auto before = remaining_offset_s(turns, odometry, late_s - half_width_s);
  const auto here = remaining_offset_s(turns, odometry, late_s);
  const auto after = remaining_offset_s(turns, odometry, late_s + half_width_s);
  if (!before || !here || !after) return comparison;
  // Noise of the turn rates scales down the remaining offset, by the same factor at every offset:
  // the true offset is the zero of the line through `before` and `after`.
  const double slope = (before->value - after->value) / (2.0 * half_width_s);
  if (slope < kMinSlope) return comparison;
  const double found_s = late_s - half_width_s + before->value / slope;
  // A second estimate, from the nearest sample. The two differ where turns are too fast for the
  // odometry's rate; half of the difference is then added to the standard deviation.
  const double by_nearest_s = late_s + here->value / slope;
  comparison.lidar_late_s = {found_s,
                             std::hypot(here->sigma / slope, 0.5 * (by_nearest_s - found_s))};
  if (const auto line = fit_line(turns_with(turns, odometry, found_s), cutoff_rad))
    comparison.ratio = {line->ratio, line->ratio_sigma};
  return comparison;
}

}  // namespace

bool TurnComparison::are_related() const {
  return !far_late_s && std::abs(ratio.value) > kSignificant * ratio.sigma;
}

bool TurnComparison::are_contradictory() const {
  return !are_related() && persistence > kMinPersistence;
}

std::optional<TurnComparison> compare_turns(const std::vector<LidarTurn>& turns,
                                            const std::vector<ImportedPose>& odometry) {
  auto comparison = compare_near(turns, odometry);
  if (comparison && comparison->persistence > kMinPersistence)
    comparison->far_late_s = far_lidar_late_s(turns, odometry);
  return comparison;
}

std::optional<HandEye> hand_eye(const std::vector<LidarMotion>& motions,
                                const std::vector<ImportedPose>& odometry, bool is_mirrored,
                                Duration lidar_late) {
  double turned_rad = 0.0;
  Equations<2, 4> equations;
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
    equations.rows.push_back(row);
    turned_rad += std::abs(wrap_angle(motion.first_from_second.theta()));
    equations.values.push_back(base.translation());
  }
  if (equations.rows.size() < kMinMotions) return std::nullopt;
  const auto solution = solve_robustly(equations, kMinResidual_m);
  if (!solution) return std::nullopt;
  const auto& [found, covariance] = *solution;
  const double scale = std::hypot(found[0], found[1]);
  if (scale < kSmallest) return std::nullopt;
  const auto sigma = [&covariance = covariance](int i) {
    return std::sqrt(covariance(i, i));
  };
  // Without turns, the lever arm is not observable.
  const double least_sigma_m = turned_rad < kMinTurned_rad ? kUnknownPlace_m : 0.0;
  const double sigma_direction = std::sqrt(0.5 * (covariance(0, 0) + covariance(1, 1)));
  return HandEye{{found[2] / scale, std::max(least_sigma_m, sigma(2) / scale)},
                 {found[3] / scale, std::max(least_sigma_m, sigma(3) / scale)},
                 {std::atan2(found[1], found[0]), sigma_direction / scale},
                 {scale, sigma_direction}};
}

}  // namespace waymark

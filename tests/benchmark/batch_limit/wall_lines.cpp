// SPDX-License-Identifier: BSD-3-Clause
#include "batch_limit/wall_lines.hpp"

#include "common/geometry/squared.hpp"

#include <Eigen/Eigenvalues>

#include <cmath>
#include <limits>
#include <optional>

namespace waymark::benchmark {
namespace {

constexpr int kSeedBeams = 12;        // neighbours that a line begins with
constexpr double kMaxGap_m = 0.6;     // between neighbours on a wall: grazing beams lie far apart
constexpr double kMinExtent_m = 0.5;  // shorter lines are clutter
constexpr double kBandSigmas = 4.0;   // beams further off a line end it
constexpr double kCutSigmas = 5.0;    // noise takes beams away that near to the longest range
constexpr double kBeginningSigmas = 2.0;  // a beginning that is rougher is no wall

/// A run of neighbouring beams, circular: beams [first, first + count).
struct Run {
  int first{0};
  int count{0};
};

class Grower {
 public:
  Grower(std::span<const AnnotatedBeam> beams, const LineNoise& noise)
      : noise_{noise}, taken_(beams.size(), false) {
    for (const AnnotatedBeam& annotated : beams)
      beams_.push_back(annotated.beam);
    for (std::size_t i = 0; i < beams_.size(); ++i)
      taken_[i] = beams_[i].range_m > noise.range_max_m - kCutSigmas * noise.range_sigma_m;
  }

  std::vector<LineOfScan> lines() {
    std::vector<LineOfScan> lines;
    for (int first = 0; first < size(); ++first) {
      const auto line = grow({first, kSeedBeams});
      if (line) lines.push_back(*line);
    }
    return lines;
  }

 private:
  int size() const { return static_cast<int>(beams_.size()); }

  std::size_t at(int index) const { return static_cast<std::size_t>((index + size()) % size()); }

  double variance_across(const Beam& beam, const Eigen::Vector2d& normal) const {
    const double across = normal.dot(beam.end_in_base - beam.start_in_base) / beam.range_m;
    return squared(noise_.range_sigma_m * across) + squared(noise_.surface_sigma_m);
  }

  bool is_on(const LineOfScan& line, const Beam& beam) const {
    const double off_m = line.normal().dot(beam.end_in_base - line.middle);
    return squared(off_m) < squared(kBandSigmas) * variance_across(beam, line.normal());
  }

  bool is_free_run(const Run& run) const {
    for (int i = run.first; i < run.first + run.count; ++i) {
      if (taken_[at(i)]) return false;
      if (i > run.first && gap_m(i - 1, i) > kMaxGap_m) return false;
    }
    return true;
  }

  double gap_m(int one, int other) const {
    return (beams_[at(one)].end_in_base - beams_[at(other)].end_in_base).norm();
  }

  LineOfScan fit(const Run& run) const {
    LineOfScan line = fit(run, std::nullopt);
    return fit(run, line.normal());
  }

  /// Weighted least squares across the line; without a normal, equal weights.
  LineOfScan fit(const Run& run, const std::optional<Eigen::Vector2d>& normal) const {
    double weight = 0.0;
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    Eigen::Matrix2d squares = Eigen::Matrix2d::Zero();
    const Eigen::Vector2d& about = beams_[at(run.first)].end_in_base;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Beam& beam = beams_[at(i)];
      const double share = normal ? 1.0 / variance_across(beam, *normal) : 1.0;
      const Eigen::Vector2d offset = beam.end_in_base - about;
      weight += share;
      sum += share * offset;
      squares += share * offset * offset.transpose();
    }
    const Eigen::Vector2d mean = sum / weight;
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> axes{
        Eigen::Matrix2d{squares / weight - mean * mean.transpose()}};
    LineOfScan line;
    line.middle = about + mean;
    Eigen::Vector2d across = axes.eigenvectors().col(0);
    if (across.dot(beams_[at(run.first)].start_in_base - line.middle) < 0.0) across = -across;
    line.normal_rad = std::atan2(across.y(), across.x());
    line.sigma_m = std::sqrt(1.0 / weight);
    line.sigma_rad = std::sqrt(1.0 / (weight * axes.eigenvalues()[1]));
    return line;
  }

  bool is_straight(const Run& run, const LineOfScan& line) const {
    double chi2 = 0.0;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Beam& beam = beams_[at(i)];
      chi2 += squared(line.normal().dot(beam.end_in_base - line.middle)) /
              variance_across(beam, line.normal());
    }
    return chi2 < squared(kBeginningSigmas) * run.count;
  }

  /// The line through a seed, grown both ways as far as it goes; its beams are taken.
  std::optional<LineOfScan> grow(Run run) {
    if (size() < 2 * kSeedBeams || !is_free_run(run)) return std::nullopt;
    LineOfScan line = fit(run);
    if (!is_straight(run, line)) return std::nullopt;
    for (int before = 0; before != run.count;) {
      before = run.count;
      while (run.count < size() && can_join(line, run.first + run.count, run.first + run.count - 1))
        ++run.count;
      while (run.count < size() && can_join(line, run.first - 1, run.first)) {
        --run.first;
        ++run.count;
      }
      line = fit(run);
    }
    const double extent_m = gap_m(run.first, run.first + run.count - 1);
    if (extent_m < kMinExtent_m) return std::nullopt;
    for (int i = run.first; i < run.first + run.count; ++i) {
      const Beam& beam = beams_[at(i)];
      taken_[at(i)] = true;
      line.points.push_back({beam.end_in_base, 1.0 / variance_across(beam, line.normal())});
    }
    return line;
  }

  bool can_join(const LineOfScan& line, int next, int last) const {
    return !taken_[at(next)] && gap_m(next, last) < kMaxGap_m && is_on(line, beams_[at(next)]);
  }

  LineNoise noise_;
  std::vector<Beam> beams_{};
  std::vector<bool> taken_;
};

}  // namespace

LineOfScan LineOfScan::part(std::size_t from, std::size_t to) const {
  const Eigen::Vector2d across = normal();
  const Eigen::Vector2d along{-across.y(), across.x()};
  const std::span<const WallPoint> chosen{points.data() + from, to - from};
  double weight = 0.0;
  Eigen::Vector2d mean = Eigen::Vector2d::Zero();
  for (const WallPoint& point : chosen) {
    weight += point.weight;
    mean += point.weight * point.end;
  }
  mean /= weight;
  double spread = 0.0;
  double rise = 0.0;
  for (const WallPoint& point : chosen) {
    const Eigen::Vector2d offset = point.end - mean;
    spread += point.weight * squared(along.dot(offset));
    rise += point.weight * along.dot(offset) * across.dot(offset);
  }
  LineOfScan part;
  part.middle = mean;
  const bool has_direction = chosen.size() > 1 && spread > 0.0;
  part.normal_rad = normal_rad - (has_direction ? rise / spread : 0.0);
  part.sigma_m = std::sqrt(1.0 / weight);
  part.sigma_rad =
      has_direction ? std::sqrt(1.0 / spread) : std::numeric_limits<double>::infinity();
  part.points.assign(chosen.begin(), chosen.end());
  return part;
}

std::vector<LineOfScan> wall_lines(std::span<const AnnotatedBeam> beams, const LineNoise& noise) {
  return Grower{beams, noise}.lines();
}

}  // namespace waymark::benchmark

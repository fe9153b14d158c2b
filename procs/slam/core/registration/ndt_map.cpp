// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/registration/ndt_map.hpp"

#include <algorithm>
#include <cmath>

namespace waymark {
namespace {

constexpr int kMinPoints = 4;         // of a cell, to have a distribution
constexpr double kPriorPoints = 6.0;  // weight of the prior on a cell's variance, in points
constexpr double kLineRatio = 0.1;    // largest ratio of variances, across to along, of a line
// A cell is thick if its variance across the wall exceeds so many times that of the points, plus
// the square of kThick_m. A flat wall's is about one times that of the points.
constexpr double kThickRatio = 3.0;
constexpr double kThick_m = 0.005;

std::int32_t column_of(NdtMap::Key key) {
  return static_cast<std::int32_t>(key >> 32);
}

std::int32_t row_of(NdtMap::Key key) {
  return static_cast<std::int32_t>(key);
}

/// Rounded to the nearest integer; `divisor` is odd and positive.
int rounded_quotient(int value, int divisor) {
  const int shifted = value + divisor / 2;
  return shifted >= 0 ? shifted / divisor : -((divisor - 1 - shifted) / divisor);
}

bool is_replaced_by_parts(const NdtCell* whole) {
  return whole != nullptr && whole->is_thick;
}

}  // namespace

NdtMap::Key NdtMap::key(int column, int row) {
  return (static_cast<std::uint64_t>(static_cast<std::uint32_t>(column)) << 32) |
         static_cast<std::uint32_t>(row);
}

NdtMap::Key NdtMap::cell_of_part(Key part) {
  return key(rounded_quotient(column_of(part), kParts), rounded_quotient(row_of(part), kParts));
}

void NdtMap::add(const Eigen::Vector2d& point, int keyframe, double weight) {
  add(point, keyframe, weight, spacing_m_, cells_);
  if (is_divided_) add(point, keyframe, weight, part_spacing_m(), parts_);
}

void NdtMap::add(const Eigen::Vector2d& point, int keyframe, double weight, double spacing_m,
                 CellMap& cells) {
  const auto column = static_cast<int>(std::floor(point.x() / spacing_m));
  const auto row = static_cast<int>(std::floor(point.y() / spacing_m));
  for (int i = column; i <= column + 1; ++i) {
    for (int k = row; k <= row + 1; ++k) {
      Cell& cell = cells[key(i, k)];
      const Eigen::Vector2d offset = point - spacing_m * Eigen::Vector2d{i, k};
      if (cell.count == 0.0) cell.distribution.first_keyframe = keyframe;
      cell.distribution.last_keyframe = keyframe;
      cell.count += weight;
      cell.sum += weight * offset;
      cell.xx += weight * offset.x() * offset.x();
      cell.xy += weight * offset.x() * offset.y();
      cell.yy += weight * offset.y() * offset.y();
      cell.fitted_with_m2 = kStale;
    }
  }
}

std::vector<NdtCellSums> NdtMap::sums() const {
  std::vector<NdtCellSums> all;
  all.reserve(cells_.size());
  for (const auto& [where, cell] : cells_) {
    all.push_back({column_of(where), row_of(where), cell.count, cell.sum,
                   Eigen::Vector3d{cell.xx, cell.xy, cell.yy}});
  }
  std::sort(all.begin(), all.end(), [](const NdtCellSums& a, const NdtCellSums& b) {
    return std::pair{a.column, a.row} < std::pair{b.column, b.row};
  });
  return all;
}

void NdtMap::add(const NdtCellSums& sums) {
  Cell& cell = cells_[key(sums.column, sums.row)];
  cell.count += sums.count;
  cell.sum += sums.sum_m;
  cell.xx += sums.squares_m2[0];
  cell.xy += sums.squares_m2[1];
  cell.yy += sums.squares_m2[2];
  cell.fitted_with_m2 = kStale;
}

NdtMap::Key NdtMap::key_at(const Eigen::Vector2d& point, double spacing_m) {
  return key(static_cast<int>(std::floor(point.x() / spacing_m + 0.5)),
             static_cast<int>(std::floor(point.y() / spacing_m + 0.5)));
}

const NdtCell* NdtMap::fitted(Key key, double point_variance_m2, double spacing_m, CellMap& cells) {
  const auto found = cells.find(key);
  if (found == cells.end() || found->second.count < kMinPoints) return nullptr;
  Cell& cell = found->second;
  NdtCell& fit = cell.distribution;
  if (cell.fitted_with_m2 == point_variance_m2) return &fit;
  const Eigen::Vector2d mean = cell.sum / cell.count;
  const double xx = cell.xx / cell.count - mean.x() * mean.x();
  const double xy = cell.xy / cell.count - mean.x() * mean.y();
  const double yy = cell.yy / cell.count - mean.y() * mean.y();
  const double half_trace = 0.5 * (xx + yy);
  const double radius = std::hypot(0.5 * (xx - yy), xy);
  const double along_rad = 0.5 * std::atan2(2.0 * xy, xx - yy);
  // Two parameters of the line were fitted to the points.
  const double across_m2 =
      std::max(0.0, half_trace - radius) * cell.count / std::max(1.0, cell.count - 2.0);
  fit.mean = spacing_m * Eigen::Vector2d{column_of(key), row_of(key)} + mean;
  fit.normal = {-std::sin(along_rad), std::cos(along_rad)};
  fit.across_m2 =
      (cell.count * across_m2 + kPriorPoints * point_variance_m2) / (cell.count + kPriorPoints);
  fit.along_m2 = half_trace + radius;
  // Without the range noise, so that a noisy LiDAR still sees a wall as a line.
  fit.is_line = fit.across_m2 - point_variance_m2 < kLineRatio * (fit.along_m2 - point_variance_m2);
  fit.is_thick = fit.across_m2 > kThickRatio * point_variance_m2 + kThick_m * kThick_m;
  fit.count = static_cast<int>(cell.count);
  cell.fitted_with_m2 = point_variance_m2;
  return &fit;
}

const NdtCell* NdtMap::at(Key key, double point_variance_m2) const {
  return fitted(key, point_variance_m2, spacing_m_, cells_);
}

const NdtCell* NdtMap::at_part(Key part, double point_variance_m2) const {
  const NdtCell* whole = at(cell_of_part(part), point_variance_m2);
  if (!is_replaced_by_parts(whole)) return whole;
  const NdtCell* fine = fitted(part, point_variance_m2, part_spacing_m(), parts_);
  return fine != nullptr ? fine : whole;
}

void NdtMap::drop_unused_parts(double point_variance_m2) {
  std::erase_if(parts_, [&](const auto& part) {
    return !is_replaced_by_parts(at(cell_of_part(part.first), point_variance_m2));
  });
  parts_.rehash(0);
}

}  // namespace waymark

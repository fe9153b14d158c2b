// SPDX-License-Identifier: BSD-3-Clause
#include "import/findings/wall_fit.hpp"

#include <Eigen/Core>
#include <Eigen/LU>

#include <cmath>

namespace waymark {

std::optional<double> scatter_about_wall_m(std::span<const double> ranges_m,
                                           std::span<const double> angles_rad) {
  // An error e of the range is an error e / r^2 of its inverse: weigh the rows by r^2.
  const auto size = static_cast<Eigen::Index>(ranges_m.size());
  Eigen::MatrixX2d rows{size, 2};
  Eigen::VectorXd values{size};
  for (Eigen::Index row = 0; row < size; ++row) {
    const auto i = static_cast<std::size_t>(row);
    const double square = ranges_m[i] * ranges_m[i];
    rows(row, 0) = square * std::cos(angles_rad[i]);
    rows(row, 1) = square * std::sin(angles_rad[i]);
    values(row) = ranges_m[i];
  }
  const Eigen::Matrix2d normal = rows.transpose() * rows;
  constexpr double kSingular = 1e-9;
  if (normal.determinant() <= kSingular * normal(0, 0) * normal(1, 1)) return std::nullopt;
  const Eigen::Vector2d line = normal.inverse() * (rows.transpose() * values);
  return std::sqrt((values - rows * line).squaredNorm() / (static_cast<double>(size) - 2.0));
}

}  // namespace waymark

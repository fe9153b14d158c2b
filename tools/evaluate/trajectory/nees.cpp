// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/nees.hpp"

#include "common/enums/enum_of.hpp"

#include <Eigen/Cholesky>

#include <algorithm>
#include <cmath>
#include <limits>

namespace waymark::evaluate {
namespace {

// Quantiles 0.025 and 0.975 of the chi-square distribution with 3 degrees of freedom.
constexpr double kBandLow = 0.2158;
constexpr double kBandHigh = 9.3484;
/// Smaller variances, of less than 1 um or 1 urad, are rounding errors.
constexpr double kSmallestVariance = 1e-12;
/// Tolerance for rounding: times are written with six decimals.
constexpr double kSameTime_s = 1e-5;
/// Tolerance for rounding: covariances are written with few digits.
constexpr double kLargestCorrelation = 1.001;
constexpr double kLeftOutShare = 0.01;

bool has_health(const std::filesystem::path& file) {
  const std::vector<std::string> lines = read_lines(file);
  return !lines.empty() && lines.front().ends_with(",health");
}

/// False if the matrix cannot be a covariance, not even a singular one. Checks pairs of axes only.
bool is_valid(const Eigen::Matrix3d& covariance) {
  const Eigen::Vector3d variances = covariance.diagonal();
  if (variances.minCoeff() < 0.0) return false;
  const Eigen::Vector3d sigmas = variances.cwiseSqrt();
  const Eigen::Matrix3d largest = kLargestCorrelation * sigmas * sigmas.transpose() +
                                  Eigen::Matrix3d::Constant(kSmallestVariance);
  return (covariance.cwiseAbs().array() <= largest.array()).all();
}

}  // namespace

std::vector<StampedCovariance> read_covariances(const std::filesystem::path& file,
                                                SkippedLines& skipped) {
  std::vector<std::string> columns{"t", "cxx", "cxy", "cxt", "cyy", "cyt", "ctt"};
  const bool with_health = has_health(file);
  if (with_health) columns.emplace_back("health");
  const CsvTable table = read_csv(file, columns, skipped);
  std::vector<StampedCovariance> covariances;
  for (const auto& row : table.rows) {
    const double xx = table.at(row, "cxx");
    const double xy = table.at(row, "cxy");
    const double xt = table.at(row, "cxt");
    const double yy = table.at(row, "cyy");
    const double yt = table.at(row, "cyt");
    const double tt = table.at(row, "ctt");
    Eigen::Matrix3d covariance;
    covariance << xx, xy, xt, xy, yy, yt, xt, yt, tt;
    const Health health = with_health ? enum_of(std::lround(table.at(row, "health")), Health::kLost)
                                      : Health::kUnknown;
    covariances.push_back({table.at(row, "t"), covariance, health});
  }
  std::stable_sort(
      covariances.begin(), covariances.end(),
      [](const StampedCovariance& a, const StampedCovariance& b) { return a.t_s < b.t_s; });
  return covariances;
}

const StampedCovariance* covariance_at(const std::vector<StampedCovariance>& covariances,
                                       double t_s) {
  const auto after = std::lower_bound(
      covariances.begin(), covariances.end(), t_s - kSameTime_s,
      [](const StampedCovariance& covariance, double time_s) { return covariance.t_s < time_s; });
  return after != covariances.end() && after->t_s <= t_s + kSameTime_s ? &*after : nullptr;
}

std::optional<double> nees_of(const PosePair& pair, const Eigen::Matrix3d& covariance,
                              const Se2& world_from_map) {
  const Eigen::LLT<Eigen::Matrix3d> factor{covariance};
  if (covariance.diagonal().minCoeff() < kSmallestVariance || factor.info() != Eigen::Success)
    return std::nullopt;
  const Se2 map_from_truth = world_from_map.inverse() * pair.world_from_truth;
  Eigen::Vector3d error;
  error << pair.map_from_estimate.translation() - map_from_truth.translation(),
      angle_difference(pair.map_from_estimate.theta(), map_from_truth.theta());
  return error.dot(factor.solve(error));
}

bool leaves_out_too_many(const Nees& nees, std::size_t left_out) {
  return static_cast<double>(left_out) >
         kLeftOutShare * static_cast<double>(nees.poses + nees.left_out());
}

Nees nees(const std::vector<PosePair>& pairs, const std::vector<StampedCovariance>& covariances,
          const Se2& world_from_map) {
  Nees result{};
  double sum = 0.0;
  std::size_t in_band = 0;
  for (const PosePair& pair : pairs) {
    const StampedCovariance* const stamped = covariance_at(covariances, pair.t_s);
    if (stamped == nullptr) {
      ++result.missing;
      continue;
    }
    const std::optional<double> value = nees_of(pair, stamped->covariance, world_from_map);
    if (!value) {
      ++(is_valid(stamped->covariance) ? result.singular : result.invalid);
      continue;
    }
    sum += *value;
    in_band += *value >= kBandLow && *value <= kBandHigh ? 1 : 0;
    ++result.poses;
  }
  const double count = static_cast<double>(result.poses);
  constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
  result.mean = result.poses == 0 ? kUnknown : sum / count;
  result.share_in_band = result.poses == 0 ? kUnknown : static_cast<double>(in_band) / count;
  return result;
}

}  // namespace waymark::evaluate

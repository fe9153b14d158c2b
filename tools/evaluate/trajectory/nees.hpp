// SPDX-License-Identifier: BSD-3-Clause
// Consistency of reported covariances with the errors (NEES).
#pragma once

#include "common/health/health.hpp"
#include "evaluate/trajectory/trajectory_error.hpp"

#include <Eigen/Core>

#include <optional>
#include <vector>

namespace waymark::evaluate {

/// Covariance of a pose in the map frame, order x y theta [m^2, m rad, rad^2].
struct StampedCovariance {
  double t_s{};
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  Health health{Health::kUnknown};
};

/// Normalised estimation error squared, e^T P^-1 e with 3 degrees of freedom: 3 on average if the
/// covariances are consistent.
struct Nees {
  std::size_t poses{};
  // Numbers of poses that are left out:
  std::size_t missing{};   ///< no covariance has their stamp
  std::size_t invalid{};   ///< a variance is negative, or a correlation above 1
  std::size_t singular{};  ///< the covariance has no inverse, e.g. that of the first pose
  double mean{};           ///< NaN if there is no pose
  double share_in_band{};  ///< between the 2.5 % and 97.5 % quantiles; 0.95 if consistent

  std::size_t left_out() const { return missing + invalid + singular; }
};

/// True if `left_out` is more than 1 % of all poses: the mean is then not that of the run.
bool leaves_out_too_many(const Nees& nees, std::size_t left_out);

/// Reads `t,cxx,cxy,cxt,cyy,cyt,ctt` and, if present, `health` of covariance.csv; in order of time.
std::vector<StampedCovariance> read_covariances(const std::filesystem::path& file,
                                                SkippedLines& skipped);

/// The covariance with that stamp, or null.
const StampedCovariance* covariance_at(const std::vector<StampedCovariance>& covariances,
                                       double t_s);

/// e^T P^-1 e of one pose; nullopt if the covariance is singular.
std::optional<double> nees_of(const PosePair& pair, const Eigen::Matrix3d& covariance,
                              const Se2& world_from_map);

/// @param world_from_map  the map's frame, known or aligned on the first pose.
Nees nees(const std::vector<PosePair>& pairs, const std::vector<StampedCovariance>& covariances,
          const Se2& world_from_map);

}  // namespace waymark::evaluate

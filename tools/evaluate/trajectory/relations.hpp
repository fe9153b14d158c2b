// SPDX-License-Identifier: BSD-3-Clause
// A trajectory against known relative poses.
#pragma once

#include "evaluate/files/tum.hpp"

#include <vector>

namespace waymark::evaluate {

/// Known pose of the base at t2 as seen from the base at t1.
struct Relation {
  std::size_t line{};
  double t1_s{};
  double t2_s{};
  Se2 base1_from_base2{};
};

struct MeanAndSigma {
  double mean{};
  double sigma{};  ///< standard deviation
};

struct RelationsSummary {
  std::size_t count{};
  MeanAndSigma translation_m{};
  MeanAndSigma rotation_deg{};
};

/// Relations between poses less than kNear_s apart measure the scan matching; between poses more
/// than kFar_s apart, loop closing.
inline constexpr double kNear_s = 5.0;
inline constexpr double kFar_s = 60.0;

struct RelationsError {
  RelationsSummary all{};
  RelationsSummary near{};
  RelationsSummary far{};
};

/// Lines `t1 t2 x y z roll pitch yaw`; '#' starts a comment. Lines of another form or out of the
/// plane are added to `skipped`. @throws SetupError if the file cannot be read or has no relation.
std::vector<Relation> read_relations(const std::filesystem::path& file, SkippedLines& skipped);

/// Mean absolute error of the relative poses; relations outside the trajectory's times are added to
/// `skipped`. Source: Kümmerle et al., "On measuring the accuracy of SLAM algorithms" (2009),
/// equation 3, separately for translation and rotation.
RelationsError relations_error(const Trajectory& trajectory, const std::vector<Relation>& relations,
                               const std::filesystem::path& relations_file, SkippedLines& skipped);

}  // namespace waymark::evaluate

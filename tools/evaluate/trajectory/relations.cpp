// SPDX-License-Identifier: BSD-3-Clause
#include "evaluate/trajectory/relations.hpp"

#include <fmt/format.h>

#include <cmath>
#include <limits>

namespace waymark::evaluate {
namespace {

MeanAndSigma mean_and_sigma(const std::vector<double>& values) {
  const double count = static_cast<double>(values.size());
  if (values.empty()) {
    constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
    return {kUnknown, kUnknown};
  }
  double sum = 0.0;
  for (const double value : values)
    sum += value;
  const double mean = sum / count;
  double squares = 0.0;
  for (const double value : values)
    squares += (value - mean) * (value - mean);
  return {mean, std::sqrt(squares / count)};
}

struct Errors {
  std::vector<double> translations_m{};
  std::vector<double> rotations_deg{};

  void add(const Se2& error) {
    translations_m.push_back(error.translation().norm());
    rotations_deg.push_back(std::abs(degrees(error.theta())));
  }

  RelationsSummary summary() const {
    return {translations_m.size(), mean_and_sigma(translations_m), mean_and_sigma(rotations_deg)};
  }
};

}  // namespace

std::vector<Relation> read_relations(const std::filesystem::path& file, SkippedLines& skipped) {
  const std::vector<std::string> lines = read_lines(file);
  std::vector<Relation> relations;
  for (std::size_t i = 0; i < lines.size(); ++i) {
    if (lines[i].empty() || lines[i].front() == '#') continue;
    const auto numbers = parse_numbers(lines[i]);
    if (!numbers || numbers->size() != 8) {
      skipped.push_back(at_line(
          file, i + 1,
          fmt::format("got '{}', expected 8 finite numbers t1 t2 x y z roll pitch yaw", lines[i])));
      continue;
    }
    const auto& n = *numbers;
    if (n[4] != 0.0 || n[5] != 0.0 || n[6] != 0.0)
      skipped.push_back(
          at_line(file, i + 1, "z, roll and pitch must be 0: trajectories are planar"));
    else
      relations.push_back({i + 1, n[0], n[1], Se2{n[2], n[3], n[7]}});
  }
  if (relations.empty())
    throw SetupError{file.string() +
                     ": no relation in it; expected lines t1 t2 x y z roll pitch yaw"};
  return relations;
}

RelationsError relations_error(const Trajectory& trajectory, const std::vector<Relation>& relations,
                               const std::filesystem::path& relations_file, SkippedLines& skipped) {
  Errors all, near, far;
  for (const Relation& relation : relations) {
    const auto map_from_base1 = pose_at(trajectory, relation.t1_s);
    const auto map_from_base2 = pose_at(trajectory, relation.t2_s);
    if (!map_from_base1 || !map_from_base2) {
      skipped.push_back(
          at_line(relations_file, relation.line,
                  fmt::format("time {:.6f} is outside the trajectory ({:.6f} to {:.6f})",
                              map_from_base1 ? relation.t2_s : relation.t1_s,
                              trajectory.front().t_s, trajectory.back().t_s)));
      continue;
    }
    const Se2 estimated_base1_from_base2 = map_from_base1->inverse() * *map_from_base2;
    const Se2 error = relation.base1_from_base2.inverse() * estimated_base1_from_base2;
    const double apart_s = std::abs(relation.t2_s - relation.t1_s);
    all.add(error);
    if (apart_s < kNear_s) near.add(error);
    if (apart_s > kFar_s) far.add(error);
  }
  return {all.summary(), near.summary(), far.summary()};
}

}  // namespace waymark::evaluate

// SPDX-License-Identifier: BSD-3-Clause
// Sparse elimination against the dense Schur complement.
#include "slam/core/graph/elimination.hpp"

#include "common/random/random.hpp"

#include <Eigen/LU>
#include <gtest/gtest.h>

#include <algorithm>
#include <map>
#include <vector>

namespace waymark {
namespace {

const Variable kCalibrationVariable{};
const Variable kKeptLandmark{VariableKind::kLandmark, 1};
constexpr Eigen::Index kNumKept = kCalibrationSize + 3;

Variable keyframe(std::size_t index) {
  return {VariableKind::kKeyframe, index};
}

Variable landmark(std::size_t index) {
  return {VariableKind::kLandmark, index};
}

Eigen::Index place_in_corner(const Variable& variable) {
  return variable == kCalibrationVariable ? 0 : kCalibrationSize;
}

/// Keyframes 3 to 8 in a chain and landmarks on both sides, of which the middle one is kept.
struct Chain {
  std::vector<Variable> eliminated{};
  std::vector<LinearFactor> factors{};

  explicit Chain(std::uint64_t seed) {
    Random random{seed};
    const auto add = [&](std::initializer_list<Variable> variables) {
      const auto draw = [&random] {
        return random.normal();
      };
      LinearFactor factor;
      factor.residual = Eigen::Vector3d::NullaryExpr(draw);
      for (const Variable& variable : variables)
        factor.blocks.push_back(
            {variable, LinearFactor::Jacobian::NullaryExpr(3, variable.size(), draw)});
      factors.push_back(factor);
    };
    for (std::size_t k = 3; k <= 8; ++k)
      eliminated.push_back(keyframe(k));
    eliminated.push_back(landmark(0));
    eliminated.push_back(landmark(2));
    add({keyframe(3)});
    for (std::size_t k = 3; k < 8; ++k) {
      add({keyframe(k), keyframe(k + 1), kCalibrationVariable});
      add({keyframe(k), landmark(k % 3), kCalibrationVariable});
    }
  }

  Elimination elimination() const { return {eliminated, factors, kNumKept, place_in_corner}; }
};

/// The same normal equations with all unknowns in order, those of the corner last.
struct Dense {
  std::map<Variable, Eigen::Index> places{};
  Eigen::Index num_eliminated{0};
  Eigen::MatrixXd h{};
  Eigen::VectorXd g{};

  explicit Dense(const Chain& chain) : num_eliminated{3 * std::ssize(chain.eliminated)} {
    for (const Variable& variable : chain.eliminated)
      places.emplace(variable, 3 * std::ssize(places));
    for (const Variable& variable : {kCalibrationVariable, kKeptLandmark})
      places.emplace(variable, num_eliminated + place_in_corner(variable));
    h = Eigen::MatrixXd::Zero(num_eliminated + kNumKept, num_eliminated + kNumKept);
    g = Eigen::VectorXd::Zero(h.rows());
    for (const LinearFactor& factor : chain.factors) {
      Eigen::MatrixXd rows = Eigen::MatrixXd::Zero(3, h.rows());
      for (const LinearFactor::Block& block : factor.blocks)
        rows.middleCols(places.at(block.variable), block.jacobian.cols()) = block.jacobian;
      h += rows.transpose() * rows;
      g += rows.transpose() * factor.residual;
    }
  }
};

TEST(Elimination, TheReducedSystemIsTheSchurComplement) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Chain chain{seed};
    const Dense dense{chain};
    const Elimination elimination = chain.elimination();
    ASSERT_TRUE(elimination.has_solution());
    const Eigen::Index n = dense.num_eliminated;
    const Eigen::MatrixXd gain =
        dense.h.bottomLeftCorner(kNumKept, n) * dense.h.topLeftCorner(n, n).inverse();
    const Eigen::MatrixXd corner_h =
        dense.h.bottomRightCorner(kNumKept, kNumKept) - gain * dense.h.topRightCorner(n, kNumKept);
    const Eigen::VectorXd corner_g = dense.g.tail(kNumKept) - gain * dense.g.head(n);
    EXPECT_LT((elimination.corner_h() - corner_h).norm(), 1e-6 * dense.h.norm()) << seed;
    EXPECT_LT((elimination.corner_g() - corner_g).norm(), 1e-6 * dense.g.norm()) << seed;
  }
}

TEST(Elimination, BackSubstitutionSolvesTheRowsOfTheEliminatedUnknowns) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    const Chain chain{seed};
    const Dense dense{chain};
    const Elimination elimination = chain.elimination();
    const Eigen::VectorXd corner_step = Eigen::VectorXd::LinSpaced(kNumKept, -1.0, 1.0);
    const Eigen::VectorXd step = elimination.step(corner_step);
    ASSERT_EQ(step.size(), dense.num_eliminated);
    Eigen::VectorXd in_order{dense.h.rows()};
    for (const Variable& variable : chain.eliminated)
      in_order.segment<3>(dense.places.at(variable)) =
          step.segment<3>(elimination.place_of(variable));
    in_order.tail(kNumKept) = corner_step;
    const Eigen::VectorXd remaining = dense.h * in_order + dense.g;
    EXPECT_LT(remaining.head(dense.num_eliminated).norm(), 1e-6 * dense.h.norm()) << seed;
  }
}

TEST(Elimination, EachEliminatedUnknownHasARowBlockOfItsOwn) {
  const Chain chain{1};
  const Elimination elimination = chain.elimination();
  std::vector<Eigen::Index> places;
  for (const Variable& variable : chain.eliminated)
    places.push_back(elimination.place_of(variable));
  std::sort(places.begin(), places.end());
  for (std::size_t i = 0; i < places.size(); ++i)
    EXPECT_EQ(places[i], 3 * static_cast<Eigen::Index>(i));
}

TEST(Elimination, AnUnknownWithoutAFactorHasNoSolution) {
  Chain chain{1};
  chain.eliminated.push_back(keyframe(9));
  EXPECT_FALSE(chain.elimination().has_solution());
}

}  // namespace
}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/damped_root.hpp"

#include <gtest/gtest.h>

namespace waymark {
namespace {

TEST(DampedRoot, APositiveDefiniteMatrixIsNotDamped) {
  const Eigen::Matrix2d h{{4.0, 1.0}, {1.0, 3.0}};
  DampedRoot root;
  root.compute(h);
  EXPECT_EQ(root.matrixL().toDenseMatrix(),
            Eigen::MatrixXd{Eigen::LLT<Eigen::MatrixXd>{h}.matrixL()});
}

TEST(DampedRoot, AMatrixThatRoundingMadeIndefiniteIsDampedMinimally) {
  const Eigen::Matrix2d h{{1e20, 1e10}, {1e10, 1.0 - 1e-9}};
  ASSERT_NE(Eigen::LLT<Eigen::MatrixXd>{h}.info(), Eigen::Success);
  DampedRoot root;
  root.compute(h);
  ASSERT_EQ(root.info(), Eigen::Success);
  const Eigen::Vector2d x = root.solve(Eigen::Vector2d{1e20, 1e10});
  EXPECT_NEAR(x.x() + 1e-10 * x.y(), 1.0, 1e-6);
}

}  // namespace
}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/graph.hpp"

#include <algorithm>

namespace waymark {
namespace {

// Newest keyframes: older motions were examined when their keyframes were among these.
constexpr std::size_t kExamined = 20;

}  // namespace

bool Graph::has_markers() const {
  return std::any_of(active_factors_.begin(), active_factors_.end(), [this](std::size_t index) {
    return std::holds_alternative<MarkerFactor>(factors_[index]);
  });
}

/// Of all changes of a motion's kind, applies the one that reduces the cost most, and takes a step
/// of the window, so that choose_kind() keeps it. The covariance of a residual J x is J P J' =
/// (L^-1 J')' (L^-1 J'); rows of L before the motion's first variable do not contribute.
/// @return false if no change reduces the cost.
bool Graph::assume_slip() {
  const std::size_t count = state_.keyframes.size();
  const std::size_t oldest = std::max(first_keyframe_, count - std::min(count, kExamined));
  OdometryFactor* slipped = nullptr;
  OdometryFactor::Change best;
  for (const std::size_t index : active_factors_) {
    auto* odometry = std::get_if<OdometryFactor>(&factors_[index]);
    if (odometry == nullptr || odometry->from < oldest) continue;
    const Eigen::Index first = offsets_.at({VariableKind::kKeyframe, odometry->from});
    const Eigen::Index size = root_.rows() - first;
    const LinearFactor linear = linearised(*odometry);
    Eigen::MatrixXd half = Eigen::MatrixXd::Zero(size, 3);
    for (const LinearFactor::Block& block : linear.blocks) {
      half.middleRows(offsets_.at(block.variable) - first, block.variable.size()) =
          block.jacobian.transpose();
    }
    root_.matrixLLT()
        .bottomRightCorner(size, size)
        .triangularView<Eigen::Lower>()
        .solveInPlace(half);
    const OdometryFactor::Change change = odometry->best_change(
        linear, half.transpose() * half, state_, noise_.odometry, noise_.learnt_odometry);
    if (change.gain <= best.gain) continue;
    best = change;
    slipped = odometry;
  }
  if (slipped == nullptr) return false;
  slipped->kind = best.kind;
  step_window();
  return true;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Marginalisation: the window's prior keeps the information of what leaves the window.
#include "slam/core/graph/graph.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

namespace waymark {

/// Adds all factors on the variable to the prior, and eliminates the variable from the prior (Schur
/// complement).
void Graph::eliminate(const Variable& variable) {
  std::vector<std::size_t> kept;
  for (const std::size_t index : active_factors_) {
    const std::vector<Variable> touched = variables_of(factors_[index]);
    if (std::find(touched.begin(), touched.end(), variable) == touched.end())
      kept.push_back(index);
    else
      add_to(prior_, linearised(factors_[index]));
  }
  active_factors_ = std::move(kept);

  const Eigen::Index at = offsets_.at(variable);
  const Eigen::Index size = variable.size();
  prior_.h = Eigen::MatrixXd{prior_.h.selfadjointView<Eigen::Lower>()};
  const Eigen::LLT<Eigen::MatrixXd> own{prior_.h.block(at, at, size, size)};
  const Eigen::MatrixXd column = prior_.h.middleCols(at, size);
  // A variable without any measurement has no information to pass on.
  const Eigen::MatrixXd gain = own.info() == Eigen::Success
                                   ? Eigen::MatrixXd{own.solve(column.transpose()).transpose()}
                                   : Eigen::MatrixXd::Zero(column.rows(), size);
  prior_.g -= gain * prior_.g.segment(at, size).eval();
  prior_.h.noalias() -= gain * column.transpose();
  remove_from_layout(variable);
}

void Graph::remove_from_layout(const Variable& variable) {
  const Eigen::Index at = offsets_.at(variable);
  const Eigen::Index size = variable.size();
  const Eigen::Index behind = prior_.g.size() - at - size;
  const auto shrink = [&](Eigen::MatrixXd& matrix) {
    matrix.middleRows(at, behind) = matrix.bottomRows(behind).eval();
    matrix.middleCols(at, behind) = matrix.rightCols(behind).eval();
    matrix.conservativeResize(matrix.rows() - size, matrix.cols() - size);
  };
  shrink(prior_.h);
  prior_.g.segment(at, behind) = prior_.g.tail(behind).eval();
  prior_.g.conservativeResize(prior_.g.size() - size);
  layout_.erase(std::find(layout_.begin(), layout_.end(), variable));
  offsets_.erase(variable);
  for (auto& [other, offset] : offsets_)
    if (offset > at) offset -= size;
}

/// Replaces the prior's calibration c by c' = c + w, w ~ N(0, Q): where H is the information about
/// c and N = (I + H Q)^-1, the information about c' is N H. The other blocks follow from
/// marginalising c.
void Graph::add_calibration_random_walk(double driven_m) {
  calibration_.fade(std::exp(-driven_m / CalibrationKnowledge::kMemory_m));
  const Eigen::Index at = offsets_.at({VariableKind::kCalibration, 0});
  prior_.h = Eigen::MatrixXd{prior_.h.selfadjointView<Eigen::Lower>()};
  using Square = Eigen::Matrix<double, kCalibrationSize, kCalibrationSize>;
  const Square q = calibration_.random_walk_variances(driven_m).asDiagonal();
  const Square own = prior_.h.block<kCalibrationSize, kCalibrationSize>(at, at);
  const Square n = (Square::Identity() + own * q).inverse();
  const Calibration g = prior_.g.segment<kCalibrationSize>(at);
  Eigen::MatrixXd column = prior_.h.middleCols<kCalibrationSize>(at);
  column.middleRows<kCalibrationSize>(at).setZero();
  prior_.h.noalias() -= column * (q * n) * column.transpose();
  prior_.g.noalias() -= column * (q * n * g);
  column = (column * n.transpose()).eval();
  column.middleRows<kCalibrationSize>(at) = n * own;
  prior_.h.middleCols<kCalibrationSize>(at) = column;
  prior_.h.middleRows<kCalibrationSize>(at) = column.transpose();
  prior_.g.segment<kCalibrationSize>(at) = n * g;
}

void Graph::forget_outside_window() {
  std::vector<Factor> kept;
  kept.reserve(active_factors_.size());
  for (std::size_t& index : active_factors_) {
    kept.push_back(std::move(factors_[index]));
    index = kept.size() - 1;
  }
  factors_ = std::move(kept);
  state_.keyframes.forget_before(first_keyframe_);
  for (std::size_t i = 0; i < is_fixed_.size(); ++i)
    if (!is_active({VariableKind::kLandmark, i})) is_fixed_[i] = true;
}

void Graph::marginalise_oldest(double keep_radius_m) {
  eliminate({VariableKind::kKeyframe, first_keyframe_++});
  std::set<std::size_t> seen;
  for (const std::size_t index : active_factors_)
    if (const auto* marker = std::get_if<MarkerFactor>(&factors_[index]))
      seen.insert(marker->landmark);
  const std::vector<Variable> layout = layout_;
  for (const Variable& variable : layout) {
    if (variable.kind != VariableKind::kLandmark || seen.contains(variable.index)) continue;
    const double away_m =
        (state_.landmarks[variable.index].translation() - state_.keyframes.back().translation())
            .norm();
    if (away_m > keep_radius_m) eliminate(variable);
  }
}

}  // namespace waymark

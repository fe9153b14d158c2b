// SPDX-License-Identifier: BSD-3-Clause
#include "slam/core/graph/graph.hpp"

#include "slam/core/graph/damped_root.hpp"

#include <algorithm>
#include <limits>

namespace waymark {

Graph::Graph(const GraphNoise& noise, const Calibration& calibration_sigmas)
    : noise_{noise}, calibration_{calibration_sigmas} {
  insert_variable({VariableKind::kCalibration, 0});
}

/// The layout has keyframes before the calibration and landmarks after it.
void Graph::insert_variable(const Variable& variable) {
  const auto place =
      variable.kind == VariableKind::kKeyframe
          ? std::find(layout_.begin(), layout_.end(), Variable{VariableKind::kCalibration, 0})
          : layout_.end();
  const Eigen::Index size = variable.size();
  const Eigen::Index at = place == layout_.end() ? prior_.g.size() : offsets_.at(*place);
  const Eigen::Index behind = prior_.g.size() - at;
  layout_.insert(place, variable);
  for (auto& [other, offset] : offsets_)
    if (offset >= at) offset += size;
  offsets_[variable] = at;
  NormalEquations grown{Eigen::MatrixXd::Zero(at + size + behind, at + size + behind),
                        Eigen::VectorXd::Zero(at + size + behind)};
  grown.g << prior_.g.head(at), Eigen::VectorXd::Zero(size), prior_.g.tail(behind);
  grown.h.topLeftCorner(at, at) = prior_.h.topLeftCorner(at, at);
  grown.h.bottomLeftCorner(behind, at) = prior_.h.bottomLeftCorner(behind, at);
  grown.h.bottomRightCorner(behind, behind) = prior_.h.bottomRightCorner(behind, behind);
  prior_ = std::move(grown);
}

std::size_t Graph::add_keyframe(const Se2& map_from_base) {
  state_.keyframes.push_back(map_from_base);
  insert_variable({VariableKind::kKeyframe, state_.keyframes.size() - 1});
  return state_.keyframes.size() - 1;
}

std::size_t Graph::add_landmark(const Se2& map_from_marker) {
  state_.landmarks.push_back(map_from_marker);
  landmark_covariances_.emplace_back(Eigen::Matrix3d::Zero());
  is_fixed_.push_back(false);
  insert_variable({VariableKind::kLandmark, state_.landmarks.size() - 1});
  return state_.landmarks.size() - 1;
}

std::size_t Graph::add_fixed_landmark(const Se2& map_from_marker,
                                      const Eigen::Matrix3d& covariance) {
  state_.landmarks.push_back(map_from_marker);
  landmark_covariances_.push_back(covariance);
  is_fixed_.push_back(true);
  return state_.landmarks.size() - 1;
}

std::vector<Variable> Graph::variables_of(const Factor& factor) const {
  struct Visitor {
    const std::vector<bool>& is_fixed;

    std::vector<Variable> operator()(const OdometryFactor& f) const {
      return {{VariableKind::kKeyframe, f.from}, {VariableKind::kKeyframe, f.to}};
    }

    std::vector<Variable> operator()(const ScanFactor& f) const {
      std::vector<Variable> variables{{VariableKind::kKeyframe, f.keyframe}};
      for (const ScanFactor::Reference& reference : f.references)
        variables.push_back({VariableKind::kKeyframe, reference.keyframe});
      return variables;
    }

    std::vector<Variable> operator()(const MarkerFactor& f) const {
      if (is_fixed[f.landmark]) return {{VariableKind::kKeyframe, f.keyframe}};
      return {{VariableKind::kKeyframe, f.keyframe}, {VariableKind::kLandmark, f.landmark}};
    }

    std::vector<Variable> operator()(const PosePrior& f) const {
      return {{VariableKind::kKeyframe, f.keyframe}};
    }

    std::vector<Variable> operator()(const LandmarkPrior& f) const {
      return {{VariableKind::kLandmark, f.landmark}};
    }
  };

  return std::visit(Visitor{is_fixed_}, factor);
}

bool Graph::is_within_window(const Factor& factor) const {
  const std::vector<Variable> variables = variables_of(factor);
  return std::all_of(variables.begin(), variables.end(),
                     [this](const Variable& variable) { return is_active(variable); });
}

void Graph::add(const Factor& factor) {
  factors_.push_back(factor);
  if (is_within_window(factor)) active_factors_.push_back(factors_.size() - 1);
}

void Graph::move_to_frame(const Se2& new_from_old) {
  constexpr double kUnknown = 1e3;  // [m, rad]
  for (std::size_t i = 0; i < state_.keyframes.size(); ++i)
    state_.keyframes[i] = new_from_old * state_.keyframes[i];
  for (Se2& landmark : state_.landmarks)
    landmark = new_from_old * landmark;
  for (Eigen::Matrix3d& covariance : landmark_covariances_)
    covariance = in_axes(new_from_old.rotation(), covariance);
  const Eigen::Matrix2d back = new_from_old.rotation().transpose();
  for (Factor& factor : factors_) {
    auto* prior = std::get_if<PosePrior>(&factor);
    if (prior == nullptr) continue;
    prior->map_from_base = new_from_old * prior->map_from_base;
    prior->root_information.leftCols<2>() = (prior->root_information.leftCols<2>() * back).eval();
    if (prior->keyframe == 0) prior->root_information = Eigen::Matrix3d::Identity() / kUnknown;
  }
}

void Graph::switch_prior(std::size_t landmark, bool is_on) {
  for (Factor& factor : factors_)
    if (auto* prior = std::get_if<LandmarkPrior>(&factor); prior && prior->landmark == landmark)
      prior->is_off = !is_on;
}

bool Graph::has_prior(std::size_t landmark) const {
  return std::ranges::any_of(factors_, [&](const Factor& factor) {
    const auto* prior = std::get_if<LandmarkPrior>(&factor);
    return prior && prior->landmark == landmark;
  });
}

/// The loss whose robust weight MarkerFactor uses.
double Graph::cost_of(const MarkerFactor& factor) const {
  const double gate = noise_.marker_gate;
  const double chi2 =
      factor.linearise(state_, std::numeric_limits<double>::infinity()).residual.squaredNorm();
  return chi2 > gate ? 2.0 * gate - gate * gate / chi2 : chi2;
}

double Graph::cost_of(const Factor& factor) const {
  if (const auto* odometry = std::get_if<OdometryFactor>(&factor))
    return odometry->cost(state_, noise_.odometry, noise_.learnt_odometry);
  if (const auto* scan = std::get_if<ScanFactor>(&factor)) return scan->cost(state_);
  if (const auto* marker = std::get_if<MarkerFactor>(&factor)) return cost_of(*marker);
  return linearised(factor).residual.squaredNorm();
}

double Graph::cost() const {
  double sum = 0.0;
  for (const Factor& factor : factors_)
    sum += cost_of(factor);
  return sum;
}

void Graph::relocate_newest(const Se2& map_from_base) {
  const std::size_t newest = state_.keyframes.size() - 1;
  const auto is_about_it = [&](const Factor& factor) {
    const std::vector<Variable> variables = variables_of(factor);
    return std::find(variables.begin(), variables.end(),
                     Variable{VariableKind::kKeyframe, newest}) != variables.end();
  };
  while (!factors_.empty() && is_about_it(factors_.back())) {  // the newest keyframe's come last
    std::erase(active_factors_, factors_.size() - 1);
    factors_.pop_back();
  }
  // After step_all() the window's prior may also constrain the newest keyframe, by marginalised
  // factors between it and variables outside the window: that information is dropped, too.
  const Variable variable{VariableKind::kKeyframe, newest};
  eliminate(variable);
  insert_variable(variable);
  state_.keyframes.back() = map_from_base;
  add(OdometryFactor{.from = newest - 1, .to = newest, .is_disabled = true});
}

void Graph::move_since(std::size_t keyframe, std::size_t landmark, const Se2& new_from_old) {
  for (std::size_t i = keyframe; i < state_.keyframes.size(); ++i)
    state_.keyframes[i] = new_from_old * state_.keyframes[i];
  for (std::size_t i = landmark; i < state_.landmarks.size(); ++i)
    state_.landmarks[i] = new_from_old * state_.landmarks[i];
  for (Factor& factor : factors_) {
    if (auto* odometry = std::get_if<OdometryFactor>(&factor); odometry && odometry->to == keyframe)
      odometry->is_disabled = true;
    if (auto* scan = std::get_if<ScanFactor>(&factor); scan && scan->keyframe == keyframe)
      scan->root_information.setZero();
  }
}

void Graph::disable_odometry_since(std::size_t keyframe) {
  for (const std::size_t index : active_factors_) {
    auto* odometry = std::get_if<OdometryFactor>(&factors_[index]);
    if (odometry != nullptr && odometry->from >= keyframe) odometry->is_disabled = true;
  }
}

void Graph::choose_kind(Factor& factor) const {
  if (auto* odometry = std::get_if<OdometryFactor>(&factor))
    odometry->choose_kind(state_, noise_.odometry, noise_.learnt_odometry);
}

LinearFactor Graph::linearised(const Factor& factor) const {
  struct Visitor {
    const Graph& graph;

    LinearFactor operator()(const OdometryFactor& f) const {
      return f.linearise(graph.state_, graph.noise_.odometry, graph.noise_.learnt_odometry);
    }

    LinearFactor operator()(const ScanFactor& f) const { return f.linearise(graph.state_); }

    LinearFactor operator()(const MarkerFactor& f) const {
      LinearFactor linear = f.linearise(graph.state_, graph.noise_.marker_gate);
      if (graph.is_fixed_[f.landmark]) {
        std::erase_if(linear.blocks, [](const LinearFactor::Block& block) {
          return block.variable.kind == VariableKind::kLandmark;
        });
      }
      return linear;
    }

    LinearFactor operator()(const PosePrior& f) const { return f.linearise(graph.state_); }

    LinearFactor operator()(const LandmarkPrior& f) const { return f.linearise(graph.state_); }
  };

  return std::visit(Visitor{*this}, factor);
}

Eigen::MatrixXd Graph::covariance(const Variable& a, const Variable& b) const {
  const auto row = covariance_offsets_.find(a);
  const auto column = covariance_offsets_.find(b);
  if (row == covariance_offsets_.end() || column == covariance_offsets_.end())
    return Eigen::MatrixXd::Zero(a.size(), b.size());
  return covariance_.block(row->second, column->second, a.size(), b.size());
}

Eigen::Matrix3d Graph::covariance_since(std::size_t keyframe) const {
  const std::size_t newest = state_.keyframes.size() - 1;
  const Eigen::Vector2d lever =
      state_.keyframes[newest].translation() - state_.keyframes[keyframe].translation();
  const auto to_own_frame = [this](std::size_t index) {
    return block_rotation(state_.keyframes[index].rotation().transpose());
  };
  Eigen::MatrixXd difference = Eigen::MatrixXd::Zero(prior_.g.size(), 3);
  difference.middleRows<3>(offsets_.at({VariableKind::kKeyframe, newest})) = to_own_frame(newest);
  difference.middleRows<3>(offsets_.at({VariableKind::kKeyframe, keyframe})) -=
      to_own_frame(keyframe) * lever_arm_jacobian(lever).transpose();
  DampedRoot root;
  root.compute(window_equations().h);
  return difference.transpose() * root.solve(difference);
}

Eigen::Matrix3d Graph::covariance_of_newest_step() const {
  const std::size_t count = state_.keyframes.size();
  if (count < 2) return Eigen::Matrix3d::Zero();
  const Variable newest{VariableKind::kKeyframe, count - 1};
  const Variable before{VariableKind::kKeyframe, count - 2};
  const Eigen::Matrix3d lever_arm =
      lever_arm_jacobian(state_.pose(newest).translation() - state_.pose(before).translation());
  const Eigen::Matrix3d common = lever_arm * covariance(before, newest);
  return covariance_of(newest) + lever_arm * covariance_of(before) * lever_arm.transpose() -
         common - common.transpose();
}

Eigen::Matrix3d Graph::landmark_covariance(std::size_t landmark) const {
  return landmark_covariances_[landmark];
}

}  // namespace waymark

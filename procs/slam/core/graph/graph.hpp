// SPDX-License-Identifier: BSD-3-Clause
// The factor graph: a window of the newest keyframes that is solved at every update, and the whole
// of it, which is solved when a loop closes.
#pragma once

#include "slam/core/graph/calibration_knowledge.hpp"
#include "slam/core/graph/factors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <map>
#include <vector>

namespace waymark {

struct GraphNoise {
  OdometryNoise odometry{};
  OdometryScale scale{};
  double marker_gate{16.3};  ///< chi^2, 3 degrees of freedom
};

/// A keyframe that is no unknown any more: it moves with another one, which stays.
struct RemovedKeyframe {
  std::size_t keyframe{0};
  std::size_t carrier{0};
};

class Graph {
 public:
  Graph(const GraphNoise& noise, const Calibration& calibration_sigmas);

  const State& state() const { return state_; }

  const std::vector<Factor>& factors() const { return factors_; }

  const GraphNoise& noise() const { return noise_; }

  OdometryNoise odometry_noise() const { return scaled(noise_.odometry, noise_.scale); }

  void set_odometry_scale(const OdometryScale& scale) { noise_.scale = scale; }

  CalibrationKnowledge& calibration_knowledge() { return calibration_; }

  bool is_calibration_doubted() const { return calibration_.is_doubted(state_.calibration); }

  std::size_t add_keyframe(const Se2& map_from_base);
  std::size_t add_landmark(const Se2& map_from_marker);

  /// One of a loaded map, which does not move.
  std::size_t add_fixed_landmark(const Se2& map_from_marker, const Eigen::Matrix3d& covariance);

  bool is_fixed(std::size_t landmark) const { return is_fixed_[landmark]; }

  /// All its variables are in the window, or it waits for optimise_all().
  void add(const Factor& factor);

  /// Moves everything into another frame. The first pose, which defined the old one, is as good as
  /// unknown then: priors of landmarks must say where the frame is.
  void move_to_frame(const Se2& new_from_old);

  /// Whether the LandmarkPrior of a landmark counts. Takes effect in optimise_all().
  void switch_prior(std::size_t landmark, bool is_on);
  bool is_prior_on(std::size_t landmark) const;

  /// Sum of chi^2 of all factors, robust where they are.
  double cost() const;

  /// The same of the measurements of one landmark.
  double cost_of_landmark(std::size_t landmark) const;

  /// Puts the newest keyframe elsewhere: what has been said about it is forgotten.
  void relocate_newest(const Se2& map_from_base);

  /// Odometry from that keyframe on has turned out to say nothing.
  void cut_odometry_since(std::size_t keyframe);

  bool is_active(const Variable& variable) const { return offsets_.contains(variable); }

  std::size_t first_active_keyframe() const { return first_keyframe_; }

  std::size_t num_active_keyframes() const { return state_.keyframes.size() - first_keyframe_; }

  /// Gauss-Newton over the window.
  void optimise() { solve_window(); }

  /// One step of Gauss-Newton over everything. What lies behind the window is eliminated where it
  /// is now, which makes the window's prior anew; the window is solved; the rest follows it.
  /// @param activated  landmarks that come back into the window.
  /// @return how far anything behind the window has moved [m, rad].
  double step_all(const std::vector<std::size_t>& activated = {});

  /// At most so many steps, until nothing moves.
  void optimise_all(int steps);

  /// Takes the oldest keyframe out of the window, and landmarks that nothing in it has seen and
  /// that are `far_m` from the newest one.
  void marginalise_oldest(double far_m);

  /// Keeps nothing but the window and its prior: keyframes and factors behind it are dropped,
  /// landmarks behind it do not move any more. After that optimise_all() must not be called.
  void forget_behind_window();

  /// The calibration changes slowly: what is known of it fades while the robot drives. Not for a
  /// graph that is solved as a whole, where it is one constant.
  void let_calibration_wander(double driven_m);

  /// Takes keyframes behind the window out: what was measured from and against them is forgotten.
  /// @param removed  in order.
  void remove_keyframes(const std::vector<RemovedKeyframe>& removed);

  bool is_removed(std::size_t keyframe) const {
    return keyframe < is_removed_.size() && is_removed_[keyframe];
  }

  /// Joint covariance of two variables of the window as of optimise(): the calibration, landmarks
  /// and the two newest keyframes. Zero for those that have come since.
  Eigen::MatrixXd covariance(const Variable& a, const Variable& b) const;

  Eigen::Matrix3d covariance_of(const Variable& a) const { return covariance(a, a); }

  /// Of the newest keyframe's pose relative to an earlier one of the window, map's axes. Factorises
  /// the window.
  Eigen::Matrix3d covariance_since(std::size_t keyframe) const;

  /// The same of the newest one relative to the one before, as of optimise(); zero of the first.
  Eigen::Matrix3d covariance_of_newest_step() const;

  /// The last one that was known: of landmarks behind the window, from when they left it.
  Eigen::Matrix3d landmark_covariance(std::size_t landmark) const;

 private:
  struct NormalEquations {
    Eigen::MatrixXd h;  ///< lower triangle
    Eigen::VectorXd g;
  };

  struct Carried {
    RemovedKeyframe keyframe{};
    Se2 carrier_from_keyframe{};
  };

  bool forget_removed(Factor& factor) const;
  void carry_removed();

  /// See OdometryFactor.
  void choose_kind(Factor& factor) const;
  LinearFactor linearised(const Factor& factor) const;
  double cost_of(const MarkerFactor& factor) const;
  bool is_within_window(const Factor& factor) const;
  void insert_variable(const Variable& variable);
  void add_to(NormalEquations& equations, const LinearFactor& linear) const;
  NormalEquations window_equations() const;
  void retract_window(const Eigen::VectorXd& step);
  Eigen::VectorXd solve_window();
  void eliminate(const Variable& variable);
  void remove_from_layout(const Variable& variable);
  void update_covariance(const Eigen::LLT<Eigen::MatrixXd, Eigen::Lower>& root);
  std::vector<Variable> variables_of(const Factor& factor) const;

  GraphNoise noise_;
  CalibrationKnowledge calibration_;
  State state_{};
  std::vector<Factor> factors_{};
  std::vector<std::size_t> active_factors_{};  ///< within the window
  std::size_t first_keyframe_{0};              ///< of the window

  std::vector<Variable> layout_{};
  std::map<Variable, Eigen::Index> offsets_{};
  NormalEquations prior_{};       ///< of the window; its gradient is that at the present state
  Eigen::MatrixXd covariance_{};  ///< of the variables in covariance_offsets_
  std::map<Variable, Eigen::Index> covariance_offsets_{};
  std::vector<Eigen::Matrix3d> landmark_covariances_{};
  std::vector<bool> is_fixed_{};    ///< landmarks
  std::vector<bool> is_removed_{};  ///< keyframes; may be shorter than all
  std::vector<Carried> carried_{};
};

}  // namespace waymark

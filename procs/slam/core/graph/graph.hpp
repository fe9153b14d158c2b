// SPDX-License-Identifier: BSD-3-Clause
// The factor graph: a window of the newest keyframes is optimised at every update, the whole graph
// after loops and other information about old poses.
#pragma once

#include "common/geometry/chi2.hpp"
#include "slam/core/graph/calibration_knowledge.hpp"
#include "slam/core/graph/damped_root.hpp"
#include "slam/core/graph/factors.hpp"

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include <map>
#include <optional>
#include <vector>

namespace waymark {

struct GraphNoise {
  OdometryNoise odometry{};  ///< as configured
  LearntOdometryNoise learnt_odometry{};
  double marker_gate{kChi2Gate3};
};

/// Normal equations of some landmarks, from which all other variables have been eliminated: with a
/// step in the landmarks' own frames, the cost is c + 2 g'step + step'H step.
struct LandmarkMarginal {
  std::vector<Se2> map_from_marker{};  ///< linearisation point
  Eigen::MatrixXd h{};
  Eigen::VectorXd g{};
};

/// A keyframe that was removed from the graph: its pose relative to its anchor stays constant.
struct RemovedKeyframe {
  std::size_t keyframe{0};
  std::size_t anchor{0};
};

class Graph {
 public:
  Graph(const GraphNoise& noise, const Calibration& calibration_sigmas);

  const State& state() const { return state_; }

  const std::vector<Factor>& factors() const { return factors_; }

  const GraphNoise& noise() const { return noise_; }

  OdometryNoise odometry_noise() const { return scaled(noise_.odometry, noise_.learnt_odometry); }

  void set_learnt_odometry_noise(const LearntOdometryNoise& learnt) {
    noise_.learnt_odometry = learnt;
  }

  CalibrationKnowledge& calibration_knowledge() { return calibration_; }

  std::vector<std::size_t> doubted_calibration_terms() const {
    return calibration_.doubted_terms(state_.calibration);
  }

  std::size_t add_keyframe(const Se2& map_from_base);
  std::size_t add_landmark(const Se2& map_from_marker);

  /// A landmark of a loaded map, which stays constant.
  std::size_t add_fixed_landmark(const Se2& map_from_marker, const Eigen::Matrix3d& covariance);

  bool is_fixed(std::size_t landmark) const { return is_fixed_[landmark]; }

  /// A factor with a variable outside the window takes effect in step_all().
  void add(const Factor& factor);

  /// Transforms the whole state into another map frame. The prior of the first pose, which defined
  /// the old frame, loses its information: priors of landmarks must define the new frame.
  void move_to_frame(const Se2& new_from_old);

  /// Switches the LandmarkPrior of a landmark on or off. Takes effect in step_all() at the latest.
  void switch_prior(std::size_t landmark, bool is_on);

  bool has_prior(std::size_t landmark) const;

  /// -2 log-likelihood of all factors, up to a constant; without the priors of calibration and
  /// window.
  double cost() const;

  /// Gives the newest keyframe another pose. A disabled odometry factor replaces all factors on
  /// that keyframe.
  void relocate_newest(const Se2& map_from_base);

  /// Moves the keyframes and landmarks from the given ones on, as a rigid body: it is not known how
  /// the robot came to that keyframe. To be followed by step_all().
  void move_since(std::size_t keyframe, std::size_t landmark, const Se2& new_from_old);

  /// Marks the motion of the window's odometry factors from `keyframe` on as unknown.
  void disable_odometry_since(std::size_t keyframe);

  bool is_active(const Variable& variable) const { return offsets_.contains(variable); }

  std::size_t first_active_keyframe() const { return first_keyframe_; }

  std::size_t num_active_keyframes() const { return state_.keyframes.size() - first_keyframe_; }

  /// Gauss-Newton over the window. If it contains markers, the newest odometry factors are then
  /// tested for slip: Gauss-Newton alone spreads a slip over neighbouring motions and the
  /// calibration. Not tested without markers: a mismatched scan looks like a slip, too.
  void optimise();

  /// One step of Gauss-Newton over the whole graph: eliminates all variables outside the window,
  /// which rebuilds the window's prior; solves the window; substitutes back. A step that increases
  /// the cost is halved, a few times, and in the end dropped.
  /// @param activated  landmarks that are put back into the window.
  /// @return largest step [m, rad] of the variables outside the window or, if there are none, of
  ///         the window's variables; infinite if there is no solution: then nothing has changed.
  double step_all(const std::vector<std::size_t>& activated = {});

  /// step_all() until it converges or has no solution, at most `steps` times.
  void optimise_all(int steps);

  /// Marginal of these landmarks, none of which is fixed, given all factors but the priors on
  /// landmarks. None: the equations have no solution. Costs about as much as step_all().
  std::optional<LandmarkMarginal> marginal_of(const std::vector<std::size_t>& landmarks) const;

  /// Marginalises the window's oldest keyframe, and landmarks that no keyframe of the window has
  /// measured and that are more than `keep_radius_m` from the newest keyframe.
  void marginalise_oldest(double keep_radius_m);

  /// Keeps only the window and its prior: drops keyframes and factors outside it, and makes
  /// landmarks outside it constants. After that step_all() must not be called.
  void forget_outside_window();

  /// Lets the calibration perform a random walk: information about it fades while the robot drives.
  /// Not for a graph that is solved as a whole, where the calibration is one constant.
  void add_calibration_random_walk(double driven_m);

  /// Removes keyframes outside the window from the graph, with all factors on them.
  /// @param removed  in ascending order.
  void remove_keyframes(const std::vector<RemovedKeyframe>& removed);

  bool is_removed(std::size_t keyframe) const {
    return keyframe < is_removed_.size() && is_removed_[keyframe];
  }

  /// Joint covariance of two variables of the window when it was last solved, map's axes. Known for
  /// the calibration, landmarks and the two keyframes that were newest then; else zero.
  Eigen::MatrixXd covariance(const Variable& a, const Variable& b) const;

  Eigen::Matrix3d covariance_of(const Variable& a) const { return covariance(a, a); }

  /// Covariance of the newest keyframe's pose relative to an earlier one of the window, map's axes.
  /// Factorises the window's equations.
  Eigen::Matrix3d covariance_since(std::size_t keyframe) const;

  /// Covariance of the newest keyframe's pose relative to the previous keyframe, map's axes, when
  /// the window was last solved; zero for the first keyframe.
  Eigen::Matrix3d covariance_of_newest_step() const;

  /// Covariance of the landmark's pose in the map's axes, from the last solution of the window that
  /// contained the landmark.
  Eigen::Matrix3d landmark_covariance(std::size_t landmark) const;

 private:
  struct NormalEquations {
    Eigen::MatrixXd h;  ///< lower triangle
    Eigen::VectorXd g;
  };

  struct AnchoredKeyframe {
    RemovedKeyframe removed{};
    Se2 anchor_from_keyframe{};
  };

  bool forget_removed(Factor& factor) const;
  /// Moves the removed keyframes with their anchors.
  void move_removed();

  /// See OdometryFactor.
  void choose_kind(Factor& factor) const;
  /// Chooses the kinds of motion and the weights of loops at the current state.
  void reconsider_factors();
  LinearFactor linearised(const Factor& factor) const;
  double cost_of(const MarkerFactor& factor) const;
  double cost_of(const Factor& factor) const;
  bool is_within_window(const Factor& factor) const;
  std::vector<Variable> variables_outside_window() const;
  std::vector<LinearFactor> factors_outside_window() const;
  void insert_variable(const Variable& variable);
  void add_to(NormalEquations& equations, const LinearFactor& linear) const;
  NormalEquations window_equations() const;
  void retract_window(const Eigen::VectorXd& step);
  Eigen::VectorXd step_window();
  bool has_markers() const;
  bool assume_slip();
  Eigen::VectorXd solve_window();
  void eliminate(const Variable& variable);
  void remove_from_layout(const Variable& variable);
  void update_covariance();
  std::vector<Variable> variables_of(const Factor& factor) const;

  GraphNoise noise_;
  CalibrationKnowledge calibration_;
  State state_{};
  std::vector<Factor> factors_{};
  std::vector<std::size_t> active_factors_{};  ///< indices of the factors within the window
  std::size_t first_keyframe_{0};              ///< oldest keyframe of the window

  std::vector<Variable> layout_{};  ///< the window's variables, in the order of its equations
  std::map<Variable, Eigen::Index> offsets_{};  ///< first row of each variable in the equations
  NormalEquations prior_{};       ///< of the window; g is the gradient at the current state
  DampedRoot root_{};             ///< root of the window's equations in the last step_window()
  Eigen::MatrixXd covariance_{};  ///< of the variables in covariance_offsets_
  std::map<Variable, Eigen::Index> covariance_offsets_{};
  std::vector<Eigen::Matrix3d> landmark_covariances_{};
  std::vector<bool> is_fixed_{};    ///< by landmark
  std::vector<bool> is_removed_{};  ///< by keyframe; may end early: later ones are not removed
  std::vector<AnchoredKeyframe> anchored_{};
};

}  // namespace waymark

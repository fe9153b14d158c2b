// SPDX-License-Identifier: BSD-3-Clause
// Loop closure: registers the newest scan in old submaps.
#pragma once

#include "common/geometry/chi2.hpp"
#include "slam/core/graph/factors.hpp"
#include "slam/core/registration/correlative_search.hpp"
#include "slam/core/registration/submap.hpp"

#include <Eigen/LU>

#include <deque>
#include <functional>
#include <optional>
#include <utility>
#include <vector>

namespace waymark {

class Fields;

struct LoopConfig {
  bool enabled{true};
  double every_m{0.5};
  double reach_m{4.0};
  double max_search_m{15.0};
  double min_inlier_share{0.8};
  double min_mapped_share{0.6};
  double min_score{0.4};
  double runner_up_share{0.85};
  double gate{kChi2Gate3};
  double surprise_share{0.85};

  /// Names, units and explanations of the keys: core_fields.cpp.
  void describe(Fields& fields);
};

/// The scan of a keyframe, registered in an old submap.
struct LoopMatch {
  std::size_t submap{0};  ///< first keyframe of the submap
  ScanMatch match{};      ///< submap frame
};

/// The pose of the newest keyframe, and how uncertain it is; covariances in the map's axes.
struct LoopSearch {
  Se2 map_from_base{};
  double driven_m{0.0};  ///< since the last search
  /// Covariance of map_from_base relative to the pose of an old keyframe.
  std::function<Eigen::Matrix3d(std::size_t keyframe)> covariance_against{};
  std::size_t first_recent_keyframe{0};  ///< submaps with this or later keyframes are not old
  /// Covariance of map_from_base relative to a recent keyframe (first_recent_keyframe or later).
  std::function<Eigen::Matrix3d(std::size_t keyframe)> covariance_since{};
};

/// Factor on the covariances by which loops are searched and gated, since these come from a
/// linearised graph and a model of the odometry: doubles the sigmas. Chosen, not measured.
inline constexpr double kLoopCovarianceMargin = 4.0;

/// The smaller of two covariances, by determinant.
inline const Eigen::Matrix3d& smaller_covariance(const Eigen::Matrix3d& a,
                                                 const Eigen::Matrix3d& b) {
  return a.determinant() < b.determinant() ? a : b;
}

/// A match within the pose's covariance and close to the estimated pose closes a loop at once. Any
/// other match is a candidate: a second match, from another place, must agree with its correction.
/// The second match is searched for around the estimated pose, and around that pose after the
/// correction.
class LoopFinder {
 public:
  LoopFinder(const LoopConfig& config, const ScanMatchConfig& scan)
      : config_{config}, scan_{scan} {}

  struct Found {
    std::size_t keyframe{0};  ///< the one whose scan was matched
    LoopMatch loop{};
    Eigen::Vector3d innovation{Eigen::Vector3d::Zero()};  ///< matched minus estimated pose, when
                                                          ///< the match was found; map axes
  };

  /// Loops to close: none, one, or two that agree, the first of which was found at an earlier
  /// keyframe.
  /// @param keyframe  the newest one.
  /// @param points    the scan of that keyframe, base frame.
  std::vector<Found> find(std::size_t keyframe, const Points& points, const LoopSearch& search,
                          const std::deque<Submap>& submaps, const State& state,
                          const RangeNoise& noise);

  /// Matches that were rejected because another place fits nearly as well.
  int num_ambiguous() const { return num_ambiguous_; }

  /// Drops the history of matches, after the map frame has changed or the robot was carried.
  void reset() {
    candidate_.reset();
    confirmed_.clear();
  }

 private:
  /// A match that does not close a loop at once; a second scan has to confirm it.
  struct Candidate {
    Found found{};
    Se2 correction{};     ///< found map_from_base * estimated map_from_base ^ -1
    Se2 map_from_base{};  ///< estimated pose
  };

  /// The newest scan, and what it is compared with.
  struct Scan {
    std::size_t keyframe{0};
    const Points& points;
    const LoopSearch& search;
    const std::deque<Submap>& submaps;
    const State& state;
    const RangeNoise& noise;
  };

  /// Where the scan is searched for: around the estimated pose, or around the candidate's.
  struct Guess {
    Se2 map_from_base{};
    std::function<Eigen::Matrix3d(std::size_t keyframe)> covariance_against{};
    bool is_estimate{true};
  };

  struct Place {
    Found found{};
    Se2 map_from_base{};      ///< matched pose
    bool is_expected{false};  ///< the match closes a loop at once
  };

  std::optional<Place> place_near(const Guess& guess, const Scan& scan);
  Guess corrected_by_candidate(const LoopSearch& search) const;
  bool agrees_with_candidate(const Place& place, const LoopSearch& search) const;
  void note_confirmed(const Found& found);
  Eigen::Matrix3d covariance_in(const Submap& old, const LoopSearch& search) const;
  const Submap* nearest_submap(const Guess& guess, const Scan& scan) const;
  std::optional<LoopMatch> match(const Submap& old, const Guess& guess, const Scan& scan);
  bool is_good(const ScanMatch& match) const;
  bool is_convincing(const ScanMatch& match) const;
  static bool is_other_place(const SearchMatch& other, const ScanMatch& match);
  const CorrelativeField& field_of(const Submap& old);

  LoopConfig config_;
  ScanMatchConfig scan_;
  /// Cache of submaps' search fields, by first keyframe; the most recently used one is last.
  std::deque<std::pair<std::size_t, CorrelativeField>> fields_{};
  std::optional<Candidate> candidate_{};
  double candidate_age_m_{0.0};    ///< distance driven since the candidate
  std::deque<Found> confirmed_{};  ///< loops that were closed, at recent keyframes, oldest first
  int num_ambiguous_{0};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Finds where the robot is in what it mapped long ago.
#pragma once

#include "slam/core/graph/factors.hpp"
#include "slam/core/registration/correlative_search.hpp"
#include "slam/core/registration/submap.hpp"

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
  double gate{16.3};
  double surprise_share{0.85};

  /// What they are, in words: core_fields.cpp.
  void describe(Fields& fields);
};

/// A scan of the newest keyframe found in an old submap.
struct LoopMatch {
  std::size_t submap{0};  ///< its first keyframe
  ScanMatch match{};      ///< submap frame
};

struct LoopSearch {
  Se2 map_from_base{};
  /// Of it, relative to the pose of an old keyframe; map's axes.
  std::function<Eigen::Matrix3d(std::size_t keyframe)> covariance_against{};
  std::size_t first_recent_keyframe{0};  ///< submaps with later ones are not old
  /// Of the pose relative to that of an earlier keyframe, which is none before
  /// first_recent_keyframe.
  std::function<Eigen::Matrix3d(std::size_t keyframe)> covariance_since{};
};

class LoopFinder {
 public:
  LoopFinder(const LoopConfig& config, const ScanMatchConfig& scan)
      : config_{config}, scan_{scan} {}

  /// Matches that two scans agree about, or that what is known of the pose supports. May be empty;
  /// the older ones of a pair were found from an earlier keyframe.
  /// @param keyframe  the newest.
  struct Found {
    std::size_t keyframe{0};
    LoopMatch loop{};
    double chi2{0.0};  ///< against the pose as it was believed
  };

  std::vector<Found> find(std::size_t keyframe, const Points& points, const LoopSearch& search,
                          const std::deque<Submap>& submaps, const State& state,
                          const RangeNoise& noise);

  int num_ambiguous() const { return num_ambiguous_; }

  /// Where the robot was found is in coordinates that are no more, or it was carried away since.
  void forget_places() {
    candidate_.reset();
    confirmed_.clear();
  }

 private:
  /// Found from one scan alone, far from where the robot was believed to be.
  struct Candidate {
    Found found{};
    Se2 correction{};  ///< map_from_base as found, relative to map_from_base as believed
    Se2 map_from_base{};
  };

  /// A submap in which the robot was found.
  struct Confirmed {
    std::size_t submap{0};  ///< its first keyframe
    std::size_t keyframe{0};
    Eigen::Vector3d off{Eigen::Vector3d::Zero()};  ///< found minus believed
  };

  void note_confirmed(const Found& found, const Eigen::Vector3d& off);
  Eigen::Matrix3d covariance_in(const Submap& old, const LoopSearch& search) const;
  const Submap* nearest_submap(const LoopSearch& search, const std::deque<Submap>& submaps,
                               const State& state) const;
  std::optional<LoopMatch> match(const Submap& old, const Points& points, const LoopSearch& search,
                                 const State& state, const RangeNoise& noise);
  bool is_good(const ScanMatch& match) const;
  static bool is_other_place(const SearchMatch& other, const ScanMatch& match);
  const CorrelativeField& field_of(const Submap& old);

  LoopConfig config_;
  ScanMatchConfig scan_;
  /// Of submaps, by first keyframe; the one searched last is last.
  std::deque<std::pair<std::size_t, CorrelativeField>> fields_{};
  std::optional<Candidate> candidate_{};
  double candidate_age_m_{0.0};        ///< driven since
  std::deque<Confirmed> confirmed_{};  ///< of keyframes that are not old
  int num_ambiguous_{0};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Markers as landmarks, averaged over their sightings.
#pragma once

#include "slam/core/scan/marker_sighting.hpp"

#include <Eigen/Core>

#include <vector>

namespace waymark {

struct Landmark {
  int id{kNoMarker};
  int instance{0};  ///< distinguishes markers of equal id, in order of their first sighting
  Se2 map_from_marker{};
  /// [m^2, m rad, rad^2] order x y yaw, map frame.
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};
  int sightings{0};
  Timestamp first_seen{};
  Timestamp last_seen{};
  int misses{0};          ///< missed detections since the last sighting
  bool was_moved{false};  ///< it was mapped at another place earlier

  /// Fewer sightings may be of a misread marker.
  bool is_confirmed() const { return sightings >= 3; }

  /// Fewer misses may be of a marker that is hard to see.
  bool is_missed() const { return misses >= 5; }
};

/// Averages sightings. Ids are not unique: sightings of one id that lie apart are of different
/// instances.
class LandmarkMap {
 public:
  static constexpr std::size_t kMaxLandmarks = 4096;  ///< more are noise, or an attack

  /// @param same_within_m  sightings of an id nearer than this are of one marker.
  explicit LandmarkMap(double same_within_m) : same_within_m_{same_within_m} {}

  /// @param pose_covariance  of map_from_base, map frame.
  void add(const MarkerSighting& sighting, const Se2& map_from_base,
           const Eigen::Matrix3d& pose_covariance);

  /// In order of (id, instance).
  std::vector<Landmark> landmarks() const;

 private:
  /// Sightings are averaged by their information. The error of the robot's pose is common to
  /// successive sightings, so that averaging does not reduce it: its mean covariance is added.
  struct Entry {
    Landmark first{};  ///< as first sighted; deviations are averaged about it
    Eigen::Matrix3d information{Eigen::Matrix3d::Zero()};
    Eigen::Vector3d weighted_deviation{Eigen::Vector3d::Zero()};
    Eigen::Matrix3d pose_covariance_sum{Eigen::Matrix3d::Zero()};

    Landmark landmark() const;
  };

  double same_within_m_;
  std::vector<Entry> entries_{};
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// The markers as one particle knows them.
#pragma once

#include "slam/core/grid/copy_on_write.hpp"
#include "slam/core/landmark/marker_measurement.hpp"
#include "slam/core/mapping/landmark_map.hpp"
#include "slam/core/proposal/pose_information.hpp"

#include <optional>
#include <vector>

namespace waymark {

/// A measurement compared with a known marker, about a pose.
struct Innovation {
  std::size_t landmark{0};
  /// Measured minus expected, base frame (x, y, yaw).
  Eigen::Vector3d residual{Eigen::Vector3d::Zero()};
  Eigen::Matrix3d by_pose{Eigen::Matrix3d::Zero()};  ///< of the expected, by (x, y, theta) in map
  Eigen::Matrix3d by_landmark{Eigen::Matrix3d::Zero()};  ///< by the marker's (x, y, yaw) in map
  Eigen::Matrix3d covariance{Eigen::Matrix3d::Zero()};   ///< of measurement and marker together
};

/// What measurement of a marker is expected at a pose, and its derivatives.
Innovation compare(const MarkerMeasurement& measurement, const Se2& map_from_marker,
                   const Eigen::Matrix3d& marker_covariance, const Se2& map_from_base);

/// Negative log-likelihood of the measurement as a function of the pose, second order.
PoseInformation information_of(const Innovation& innovation);

/// An id is a class: several markers may have it, told apart by place. Copies share what neither
/// has changed since.
class MarkerLandmarks {
 public:
  /// The marker with the measurement's id that fits best; nothing when none of that id is known.
  /// @param pose_covariance  of the pose, map frame: how far off a fitting marker may seem.
  struct Candidate {
    Innovation innovation{};
    double distance{0.0};    ///< squared, Mahalanobis
    double distance_m{0.0};  ///< between expected and measured place
  };

  std::optional<Candidate> nearest(const MarkerMeasurement& measurement, const Se2& map_from_base,
                                   const Eigen::Matrix3d& pose_covariance) const;

  Innovation compare_with(std::size_t landmark, const MarkerMeasurement& measurement,
                          const Se2& map_from_base) const;

  /// Kalman update of a known marker, the pose taken as true.
  void update(std::size_t landmark, const MarkerMeasurement& measurement, const Se2& map_from_base);

  /// A marker never seen before.
  void add(const MarkerMeasurement& measurement, const Se2& map_from_base);

  std::size_t size() const { return landmarks_.size(); }

  const Landmark& operator[](std::size_t landmark) const { return *landmarks_[landmark].get(); }

 private:
  std::vector<CopyOnWrite<Landmark>> landmarks_{};
};

}  // namespace waymark

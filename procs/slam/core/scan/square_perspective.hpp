// SPDX-License-Identifier: BSD-3-Clause
// Focal length of a camera from the perspective of one square.
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>

namespace waymark {

/// Measured relative error of a focal length: the true one is (1 + error) times the configured one.
struct FocalMeasurement {
  double error{0.0};
  double sigma{0.0};
};

/// From an upright square seen at an angle: the lengths of its vertical edges give their distances
/// from the camera relative to the focal length, and its width equals its height.
/// @param corners  clockwise from the top left, as seen by a level camera with focal length 1.
/// @param corner_sigma  of a corner coordinate, same unit.
/// @return none for a frontal view, which has too little perspective.
std::optional<FocalMeasurement> focal_error_of(const std::array<Eigen::Vector2d, 4>& corners,
                                               double corner_sigma);

}  // namespace waymark

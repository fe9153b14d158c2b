// SPDX-License-Identifier: BSD-3-Clause
// What can be learnt about a camera from the perspective of one square.
#pragma once

#include <Eigen/Core>

#include <array>
#include <optional>

namespace waymark {

/// Relative error of a focal length: the true one is (1 + error) times the configured one.
struct FocalSighting {
  double error{0.0};
  double sigma{0.0};
};

/// An upright square seen at an angle: its vertical edges show how far they are from the camera in
/// units of the focal length, and the square is as deep as it is high.
/// @param corners  clockwise from the top left, as seen by a level camera with focal length 1.
/// @param corner_sigma  of a corner coordinate, same unit.
/// @return nothing for a view from the front, which has no perspective.
std::optional<FocalSighting> focal_error_of(const std::array<Eigen::Vector2d, 4>& corners,
                                            double corner_sigma);

}  // namespace waymark

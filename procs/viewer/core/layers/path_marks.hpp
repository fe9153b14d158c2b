// SPDX-License-Identifier: BSD-3-Clause
// Marks along the path: health, covariance ellipses, and weak axes (WeakAxis).
#pragma once

#include "viewer/core/drawing/map_viewport.hpp"
#include "viewer/core/scene/scene.hpp"

#include <opencv2/core.hpp>

#include <optional>
#include <vector>

namespace waymark::viewer {

/// Semi-axes [m], longer first, and the longer one's direction in the map.
struct Ellipse {
  double major_m{0.0}, minor_m{0.0}, angle_rad{0.0};
};

/// 2-sigma ellipse of the position; nullopt for an invalid covariance (not finite, not positive
/// semidefinite).
std::optional<Ellipse> two_sigma_ellipse(const Eigen::Matrix3d& covariance);

/// The poses at which the uncertainty is drawn, and how large.
struct UncertaintyMarks {
  int magnification{1};                    ///< factor that makes ellipses and weak axes visible
  double px_per_m{1.0};                    ///< scale of the page that the marks were chosen for
  double spacing_m{1.0};                   ///< distance along the path between marks
  std::vector<EstimatedPose> ellipses{};   ///< in order of time; each has an ellipse
  std::vector<EstimatedPose> weak_axes{};  ///< in order of time; each has a weak axis
};

/// Ellipses: at a round spacing along the path, and at its end. Weak axes: where one begins, where
/// another source begins to observe it, and at the same spacing in between. Where marks are too
/// close to each other, the largest ellipse and the weak axis with the worst source are kept; the
/// least distance grows until at most 60 of each kind are left. O(n + c log c + c m): n poses, c
/// candidates, m marks kept in the first pass.
UncertaintyMarks choose_marks(const std::vector<EstimatedPose>& estimates, double px_per_m,
                              double spacing_px);

/// Two-sigma ellipses, magnified.
void draw_ellipses(cv::Mat& panel, const MapViewport& view, const UncertaintyMarks& marks);

/// A bar along each weak axis in the colour of what observed the motion along it; its half length
/// is two sigma of one scan along it, magnified, within limits. A ring where the weak axis is
/// mainly the heading.
void draw_weak_axes(cv::Mat& panel, const MapViewport& view, const UncertaintyMarks& marks);

/// One bar as draw_weak_axes() draws it.
/// @param scale  factor on its width and caps; 1 = full size.
void draw_weak_axis_bar(cv::Mat& image, cv::Point2d from_px, cv::Point2d to_px,
                        WeakAxisSource source, double scale);

/// A broad band along the path wherever the health is not `tracking`; draw it before the path.
void draw_health(cv::Mat& panel, const MapViewport& view,
                 const std::vector<EstimatedPose>& estimates, int width_px);

cv::Scalar colour_of(Health health);

}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// The grey levels of a marker in an image, as a function of where it lies, of light and of blur.
#pragma once

#include "detector/core/marker_candidates.hpp"
#include "detector/core/marker_pattern.hpp"

#include <Eigen/Core>

#include <optional>

namespace waymark {

/// How a camera sees a marker. The marker's plane has the coordinates -1 to 1 along the sides of
/// the black square (x right, y down); the image has "units": pixels from the first corners'
/// centre, as a share of the distance from it to the farthest of them.
struct PatternView {
  static constexpr int kHomography = 0;  ///< units from plane: 8 entries by rows, the ninth is 1
  static constexpr int kBlur = 8;        ///< standard deviations of the lens's blur along u, v [px]
  static constexpr int kWhite = 10;      ///< grey level a + b x + c y of white: a, b, c
  static constexpr int kBlack = 13;      ///< the same of black
  /// Grey levels beyond a quiet zone of one module: left, right, top, bottom.
  static constexpr int kBeyond = 16;
  static constexpr int kSize = 20;
  using Vector = Eigen::Matrix<double, kSize, 1>;

  Vector values{Vector::Zero()};

  double contrast() const { return values[kWhite] - values[kBlack]; }
};

/// A pixel's grey level by the model, with its derivatives by the entries of PatternView::values.
struct ModelledPixel {
  double grey{0.0};
  PatternView::Vector gradient{PatternView::Vector::Zero()};
};

/// A plane pattern behind a lens with Gaussian blur, averaged over each pixel's area. Along edges
/// that are straight and longer than the blur this is exact; where the blur is aslant to the
/// marker's axes, corners of modules are right to first order in the covariance.
class PatternImage {
 public:
  /// @param pattern     is kept as a reference.
  /// @param corners_px  of the black square, ideal pixels; they define the units of the image.
  PatternImage(const MarkerPattern& pattern, const Corners& corners_px);

  /// The homography that maps the black square to the corners; everything else is 0.
  /// nullopt where three corners are in a line.
  std::optional<PatternView> view_of(const Corners& corners_px) const;

  Corners corners_px(const PatternView& view) const;
  /// Derivative of the corners (u0 v0 u1 v1 ..) by the homography [px].
  Eigen::Matrix<double, 8, 8> corner_jacobian(const PatternView& view) const;

  /// nullopt for a pixel behind the camera, or where the view is degenerate.
  std::optional<ModelledPixel> pixel(const PatternView& view,
                                     const Eigen::Vector2d& ideal_px) const;

  /// Modules right of and below the black square's top left corner, with the derivative by the
  /// pixel [modules/px]. nullopt as for pixel().
  struct Place {
    Eigen::Vector2d modules{};
    Eigen::Matrix2d modules_per_px{};
  };

  std::optional<Place> place(const PatternView& view, const Eigen::Vector2d& ideal_px) const;

 private:
  const MarkerPattern& pattern_;
  double half_modules_;
  Eigen::Vector2d centre_px_;
  double unit_px_{0.0};
};

}  // namespace waymark

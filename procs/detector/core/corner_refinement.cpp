// SPDX-License-Identifier: BSD-3-Clause
#include "detector/core/corner_refinement.hpp"

#include "common/geometry/median.hpp"
#include "common/geometry/squared.hpp"
#include "detector/core/pattern_image.hpp"
#include "detector/core/pattern_pixels.hpp"

#include <Eigen/Cholesky>
#include <Eigen/LU>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace waymark {
namespace {

using Vector = PatternView::Vector;
using Matrix = Eigen::Matrix<double, PatternView::kSize, PatternView::kSize>;

constexpr std::size_t kLeastPixels = 60;  // three for each entry of PatternView

// A pixel is far from the model if it is off by so many standard deviations of the others, and by
// such a share of the contrast.
constexpr double kFarSigmas = 3.0;
constexpr double kFarShare = 0.2;
constexpr double kLeastSigma = 0.7;  // [grey levels] rounding
// Neighbouring pixels err together, by what blur and printer do beyond the model and by JPEG, so
// that N of them carry the information of N / 2 independent ones (measured on rendered markers).
constexpr double kSharedNoise = 2.0;

// What is assumed of light and blur before the image is seen: mean and standard deviation.
constexpr double kBlurPx = 0.5;
constexpr double kBlurSigmaPx = 1.0;
constexpr double kLightSlopeSigma = 0.1;  // from centre to edge, share of the contrast
constexpr double kBeyondSigma = 0.5;      // share of the contrast
// First levels of white and black: of their pixels, edges included, those that are clear.
constexpr double kPlateau = 0.8;
constexpr double kFirstBlurPx = 1.0;  // wide, so that an edge two pixels off is felt
constexpr double kLeastBlurPx = 0.1;
constexpr double kMostBlurPx = 6.0;
constexpr double kMostBlurStepPx = 0.3;

constexpr int kMostSteps = 20;  // of a stage
constexpr double kFirstDamping = 1e-3;
constexpr double kDampingFactor = 10.0;
constexpr double kMostDamping = 100.0;

/// One descent of several, from rough to fine.
struct Stage {
  std::size_t pixels{0};  ///< at most
  int free_entries{0};    ///< of PatternView::values, the first ones
  /// Scale of Cauchy's weights, share of the contrast: pixels that are off by much more, by glare
  /// or dirt, hardly count.
  double robust_share{0.0};
  double converged_px{0.0};  ///< a step that would move every corner by less is not taken
};

constexpr std::array kStages{Stage{200, PatternView::kWhite, 0.4, 0.1},
                             Stage{200, PatternView::kWhite, 0.1, 0.05},
                             Stage{400, PatternView::kSize, 0.1, 0.05},
                             Stage{kMostPatternPixels, PatternView::kSize, 0.1, 0.01}};

double quantile(std::vector<double> values, double share) {
  const auto at =
      values.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(values.size() - 1));
  std::ranges::nth_element(values, at);
  return *at;
}

double largest_move_px(const Corners& from, const Corners& to) {
  double largest = 0.0;
  for (std::size_t k = 0; k < 4; ++k)
    largest = std::max(largest, (to[k] - from[k]).norm());
  return largest;
}

/// Residuals of the model at a view, with their derivatives; rows are pixels.
struct ImageResiduals {
  Eigen::VectorXd residuals{};
  Eigen::Matrix<double, Eigen::Dynamic, PatternView::kSize, Eigen::RowMajor> jacobian{};
};

struct NormalEquations {
  Matrix information{Matrix::Zero()};
  Vector gradient{Vector::Zero()};
};

class PatternFit {
 public:
  PatternFit(const MarkerPattern& pattern, const Corners& ideal_corners_px)
      : pattern_{pattern}, image_{pattern, ideal_corners_px} {}

  /// False where the pixels cannot be fitted at all.
  bool start(const Corners& ideal_corners_px, const std::vector<GreyPixel>& pixels) {
    const auto view = image_.view_of(ideal_corners_px);
    if (!view || pixels.size() < kLeastPixels) return false;
    view_ = *view;
    view_.values.segment<2>(PatternView::kBlur).setConstant(kFirstBlurPx);
    std::vector<double> white;
    std::vector<double> black;
    for (const GreyPixel& pixel : pixels) {
      const auto place = image_.place(view_, pixel.ideal_px);
      if (!place) continue;
      (pattern_.is_white_at(place->modules) ? white : black).push_back(pixel.grey);
    }
    if (white.empty() || black.empty()) return false;
    view_.values[PatternView::kWhite] = quantile(std::move(white), kPlateau);
    view_.values[PatternView::kBlack] = quantile(std::move(black), 1.0 - kPlateau);
    view_.values.segment<4>(PatternView::kBeyond).setConstant(view_.values[PatternView::kWhite]);
    contrast_ = view_.contrast();
    return contrast_ > 0.0;
  }

  /// Levenberg-Marquardt. False where the model is no longer finite.
  bool descend(const std::vector<GreyPixel>& all, const Stage& stage) {
    const std::span pixels = std::span{all}.first(std::min(all.size(), stage.pixels));
    robust_scale_ = stage.robust_share * contrast_;
    double damping = kFirstDamping;
    ImageResiduals here = linearize(view_, pixels);
    weigh(here);
    for (int step = 0; step < kMostSteps && damping < kMostDamping; ++step) {
      const PatternView next = moved(normal_, stage.free_entries, damping);
      if (!next.values.allFinite()) return false;
      const double moved_px = largest_move_px(image_.corners_px(view_), image_.corners_px(next));
      if (moved_px < stage.converged_px) break;
      ImageResiduals there = linearize(next, pixels);
      if (!(cost(next, there) < cost(view_, here))) {
        damping *= kDampingFactor;
        continue;
      }
      damping /= kDampingFactor;
      view_ = next;
      here = std::move(there);
      weigh(here);
    }
    const double far = std::max(kFarSigmas * sigma_, kFarShare * contrast_);
    unexplained_share_ = (here.residuals.array().abs() > far).cast<double>().mean();
    return true;
  }

  const PatternView& view() const { return view_; }

  /// Standard deviation of the pixels about the model [grey levels].
  double sigma() const { return sigma_; }

  /// Share of the pixels that are far from the model.
  double unexplained_share() const { return unexplained_share_; }

  MeasuredCorners corners(double corner_sigma_px) const {
    MeasuredCorners measured;
    measured.ideal_px = image_.corners_px(view_);
    const Matrix covariance = kSharedNoise * normal_.information.inverse();
    const auto jacobian = image_.corner_jacobian(view_);
    measured.covariance = jacobian * covariance.topLeftCorner<8, 8>() * jacobian.transpose();
    measured.covariance.diagonal().array() += corner_sigma_px * corner_sigma_px;
    measured.refined = true;
    measured.blur_px = view_.values.segment<2>(PatternView::kBlur).maxCoeff();
    return measured;
  }

 private:
  ImageResiduals linearize(const PatternView& view, std::span<const GreyPixel> pixels) const {
    ImageResiduals result;
    const auto count = std::ssize(pixels);
    result.residuals = Eigen::VectorXd::Zero(count);
    result.jacobian.setZero(count, PatternView::kSize);
    for (Eigen::Index i = 0; i < count; ++i) {
      const GreyPixel& pixel = pixels[static_cast<std::size_t>(i)];
      const auto modelled = image_.pixel(view, pixel.ideal_px);
      if (!modelled) continue;
      result.residuals[i] = pixel.grey - modelled->grey;
      result.jacobian.row(i) = modelled->gradient.transpose();
    }
    return result;
  }

  /// Scatter and normal equations at the present view.
  void weigh(const ImageResiduals& here) {
    sigma_ = scatter(here.residuals);
    normal_ = normal_equations(view_, here);
  }

  double cost(const PatternView& view, const ImageResiduals& at) const {
    const Eigen::ArrayXd squares = (at.residuals.array() / robust_scale_).square();
    const double of_pixels = squared(robust_scale_ / sigma_) * (1.0 + squares).log().sum();
    const Assumptions assumed = assumptions(view);
    return of_pixels + assumed.residuals.squaredNorm();
  }

  NormalEquations normal_equations(const PatternView& view, const ImageResiduals& at) const {
    const Eigen::ArrayXd squares = (at.residuals.array() / robust_scale_).square();
    const Eigen::ArrayXd weights = 1.0 / ((1.0 + squares) * squared(sigma_));
    const auto weighted = (at.jacobian.array().colwise() * weights.sqrt()).matrix().eval();
    const Assumptions assumed = assumptions(view);
    NormalEquations normal;
    normal.information.selfadjointView<Eigen::Lower>().rankUpdate(weighted.transpose());
    normal.information.selfadjointView<Eigen::Lower>().rankUpdate(assumed.jacobian.transpose());
    normal.information = normal.information.selfadjointView<Eigen::Lower>().toDenseMatrix().eval();
    normal.gradient = at.jacobian.transpose() * (weights * at.residuals.array()).matrix() +
                      assumed.jacobian.transpose() * assumed.residuals;
    return normal;
  }

  /// Residuals, in standard deviations, of what is assumed before the image is seen.
  struct Assumptions {
    Eigen::Matrix<double, 10, 1> residuals{};
    Eigen::Matrix<double, 10, PatternView::kSize> jacobian{};
  };

  Assumptions assumptions(const PatternView& view) const {
    const Vector& p = view.values;
    Assumptions result;
    result.jacobian.setZero();
    Eigen::Index row = 0;
    const auto add = [&](int entry, double expected, double sigma) {
      result.residuals[row] = (expected - p[entry]) / sigma;
      result.jacobian(row, entry) = 1.0 / sigma;
      return row++;
    };
    for (const int i : {0, 1})
      add(PatternView::kBlur + i, kBlurPx, kBlurSigmaPx);
    for (const int i : {1, 2}) {
      add(PatternView::kWhite + i, 0.0, kLightSlopeSigma * contrast_);
      add(PatternView::kBlack + i, 0.0, kLightSlopeSigma * contrast_);
    }
    for (int i = PatternView::kBeyond; i < PatternView::kSize; ++i) {
      const double sigma = kBeyondSigma * contrast_;
      result.jacobian(add(i, p[PatternView::kWhite], sigma), PatternView::kWhite) = -1.0 / sigma;
    }
    return result;
  }

  PatternView moved(const NormalEquations& normal, int free_entries, double damping) const {
    Matrix damped = normal.information;
    damped.diagonal() *= 1.0 + damping;
    Vector step = Vector::Zero();
    step.head(free_entries) = damped.topLeftCorner(free_entries, free_entries)
                                  .ldlt()
                                  .solve(normal.gradient.head(free_entries));
    auto blur_step = step.segment<2>(PatternView::kBlur);
    blur_step = blur_step.cwiseMax(-kMostBlurStepPx).cwiseMin(kMostBlurStepPx).eval();
    PatternView next{view_.values + step};
    auto blur = next.values.segment<2>(PatternView::kBlur);
    blur = blur.cwiseMax(kLeastBlurPx).cwiseMin(kMostBlurPx).eval();
    return next;
  }

  static double scatter(const Eigen::VectorXd& residuals) {
    std::vector<double> sizes(static_cast<std::size_t>(residuals.size()));
    std::ranges::transform(residuals, sizes.begin(), [](double r) { return std::abs(r); });
    return std::max(kLeastSigma, kSigmaOfMad * upper_median(std::move(sizes)));
  }

  const MarkerPattern& pattern_;
  PatternImage image_;
  PatternView view_{};
  NormalEquations normal_{};
  double contrast_{0.0};  ///< at the start
  double robust_scale_{1.0};
  double sigma_{1.0};
  double unexplained_share_{0.0};
};

}  // namespace

void RefinementConfig::describe(Fields& fields) {
  fields.field("min_contrast", min_contrast, {1.0, 255.0},
               "grey levels between black and white that a marker needs");
  fields.field("max_residual", max_residual, kPositive,
               "scatter of the grey levels about the fitted pattern, as a share of the contrast, "
               "that is still the marker");
  fields.field(
      "max_unexplained_share", max_unexplained_share, kFraction,
      "share of the pixels that may be far from the fitted pattern, by shadow, glare or dirt");
  fields.field("max_move_px", max_move_px, kPositive,
               "a corner that would move further stays where it was");
  fields.field("corner_sigma_px", corner_sigma_px, kNotNegative,
               "standard deviation of a corner beyond what the scatter of the grey levels says");
  fields.field("unrefined_sigma_px", unrefined_sigma_px, kPositive,
               "standard deviation of a corner that could not be refined");
}

MeasuredCorners refine_corners(const cv::Mat& gray, const CameraModel& camera,
                               const Corners& raw_corners_px, const MarkerPattern& pattern,
                               const RefinementConfig& config) {
  MeasuredCorners unrefined;
  for (std::size_t k = 0; k < 4; ++k)
    unrefined.ideal_px[k] = camera.ideal_from_raw(raw_corners_px[k]);
  unrefined.covariance *= config.unrefined_sigma_px * config.unrefined_sigma_px;

  const auto pixels = pixels_near_borders(gray, camera, raw_corners_px, pattern);
  PatternFit fit{pattern, unrefined.ideal_px};
  if (!fit.start(unrefined.ideal_px, pixels)) return unrefined;
  for (const Stage& stage : kStages) {
    if (!fit.descend(pixels, stage)) return unrefined;
  }
  if (!(fit.view().contrast() >= config.min_contrast) ||
      !(fit.sigma() <= config.max_residual * fit.view().contrast()) ||
      fit.unexplained_share() > config.max_unexplained_share) {
    return unrefined;
  }
  MeasuredCorners measured = fit.corners(config.corner_sigma_px);
  const bool is_plausible =
      measured.covariance.allFinite() &&
      largest_move_px(unrefined.ideal_px, measured.ideal_px) <= config.max_move_px;
  return is_plausible ? measured : unrefined;
}

}  // namespace waymark

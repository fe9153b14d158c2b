// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/layers/path_marks.hpp"

#include "common/random/random.hpp"
#include "viewer/core/drawing/palette.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <opencv2/imgproc.hpp>

#include <cmath>
#include <limits>

namespace waymark::viewer {
namespace {

using ::testing::AllOf;

using ::testing::Ge;
using ::testing::IsEmpty;
using ::testing::Le;
using ::testing::SizeIs;

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kInf = std::numeric_limits<double>::infinity();
constexpr double kPxPerM = 100.0;
constexpr double kSpacing_px = 120.0;  // 2 m at this scale

Eigen::Matrix3d covariance(double sigma_x_m, double sigma_y_m) {
  return Eigen::Vector3d{sigma_x_m * sigma_x_m, sigma_y_m * sigma_y_m, 1e-4}.asDiagonal();
}

EstimatedPose pose_at(int index, double x_m, double y_m, double sigma_m) {
  return {.time = Timestamp{Duration{index}},
          .map_from_base = {x_m, y_m, 0.0},
          .covariance = covariance(sigma_m, sigma_m),
          .health = Health::kTracking};
}

std::vector<EstimatedPose> straight_path(double length_m, double sigma_m) {
  std::vector<EstimatedPose> path;
  for (int i = 0; i <= std::lround(length_m / 0.1); ++i)
    path.push_back(pose_at(i, 0.1 * i, 0.0, sigma_m));
  return path;
}

WeakAxis axis_along(double x, double y, double heading, WeakAxisSource source,
                    double information = 100.0) {
  return {.direction = {x, y, heading}, .information = information, .source = source};
}

/// A picture of 2 m x 2 m around the origin of the map, with 200 x 200 pixels.
struct Sheet {
  MapViewport view{.box = {-1.0, -1.0, 1.0, 1.0}, .px_per_m = kPxPerM};
  cv::Mat_<Colour> image = cv::Mat_<Colour>(200, 200, Colour{255, 255, 255});

  cv::Rect drawn_box() const {
    cv::Mat grey;
    cv::cvtColor(image, grey, cv::COLOR_BGR2GRAY);
    return cv::boundingRect(cv::Mat{grey < 255});
  }

  bool is_blank() const { return drawn_box().empty(); }

  bool has(const cv::Scalar& colour, int x, int y) const {
    return image(y, x) == to_colour(colour);
  }
};

UncertaintyMarks only(const EstimatedPose& pose) {
  return {.px_per_m = kPxPerM, .ellipses = {pose}, .weak_axes = {pose}};
}

TEST(TwoSigmaEllipse, SemiAxesAreTwoSigmas) {
  const auto ellipse = two_sigma_ellipse(covariance(0.01, 0.03));
  ASSERT_TRUE(ellipse);
  EXPECT_NEAR(ellipse->major_m, 0.06, 1e-12);
  EXPECT_NEAR(ellipse->minor_m, 0.02, 1e-12);
  EXPECT_NEAR(std::abs(std::sin(ellipse->angle_rad)), 1.0, 1e-9) << "along y";
}

TEST(TwoSigmaEllipse, TurnsWithTheCovariance) {
  const double angle_rad = radians(30);
  Eigen::Matrix3d turned = Eigen::Matrix3d::Zero();
  const Eigen::Matrix2d rotation = Eigen::Rotation2Dd{angle_rad}.toRotationMatrix();
  turned.topLeftCorner<2, 2>() =
      rotation * Eigen::Vector2d{0.04, 0.01}.asDiagonal() * rotation.transpose();
  const auto ellipse = two_sigma_ellipse(turned);
  ASSERT_TRUE(ellipse);
  EXPECT_NEAR(ellipse->major_m, 0.4, 1e-9);
  EXPECT_NEAR(ellipse->minor_m, 0.2, 1e-9);
  EXPECT_NEAR(std::sin(ellipse->angle_rad - angle_rad), 0.0, 1e-9);
}

TEST(TwoSigmaEllipse, RejectsInvalidCovariances) {
  for (const double wrong : {kNan, kInf, -kInf, -1e-4}) {
    Eigen::Matrix3d matrix = covariance(0.01, 0.01);
    matrix(1, 1) = wrong;
    EXPECT_FALSE(two_sigma_ellipse(matrix)) << wrong;
  }
  Eigen::Matrix3d correlated_too_much = covariance(0.01, 0.01);
  correlated_too_much(0, 1) = correlated_too_much(1, 0) = 2e-4;
  EXPECT_FALSE(two_sigma_ellipse(correlated_too_much));
}

TEST(TwoSigmaEllipse, ZeroCovarianceIsAPoint) {
  const auto ellipse = two_sigma_ellipse(Eigen::Matrix3d::Zero());
  ASSERT_TRUE(ellipse);
  EXPECT_EQ(ellipse->major_m, 0.0);
}

TEST(ChooseMarks, AnEmptyPathHasNoMarksAndOnePoseHasOne) {
  EXPECT_THAT(choose_marks({}, kPxPerM, kSpacing_px).ellipses, IsEmpty());
  EXPECT_EQ(choose_marks({}, kPxPerM, kSpacing_px).magnification, 1);
  EXPECT_THAT(choose_marks({pose_at(0, 1, 2, 0.1)}, kPxPerM, kSpacing_px).ellipses, SizeIs(1));
}

TEST(ChooseMarks, EllipsesAreAtRoundDistancesAndAtTheEnd) {
  const auto marks = choose_marks(straight_path(9.0, 0.05), kPxPerM, kSpacing_px);
  EXPECT_EQ(marks.spacing_m, 2.0);
  EXPECT_THAT(marks.ellipses, SizeIs(AllOf(Ge(4U), Le(5U))));
  EXPECT_NEAR(marks.ellipses.back().map_from_base.x(), 9.0, 1e-9);
}

TEST(ChooseMarks, NonFinitePosesAreSkipped) {
  std::vector<EstimatedPose> path = straight_path(9.0, 0.05);
  for (EstimatedPose& pose : path) {
    pose.covariance(0, 0) = kNan;
    pose.weak_axis = axis_along(kNan, 0, 0, WeakAxisSource::kOdometry);
  }
  path.push_back(pose_at(1'000'000, kNan, 0.0, 0.1));
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  EXPECT_THAT(marks.ellipses, IsEmpty());
  EXPECT_THAT(marks.weak_axes, IsEmpty());
}

TEST(ChooseMarks, WhereAPathReturnsTheMarksOfTheLessCertainPassAreKept) {
  std::vector<EstimatedPose> path = straight_path(9.0, 0.05);
  const int there = static_cast<int>(path.size());
  for (int i = 0; i < there; ++i)
    path.push_back(pose_at(there + i, 9.0 - 0.1 * i, 0.0, 0.2));
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  EXPECT_THAT(marks.ellipses, SizeIs(Le(7U)));
  for (const EstimatedPose& pose : marks.ellipses) {
    if (pose.map_from_base.x() >= 8.0) continue;
    EXPECT_GE(to_us(pose.time), there);
  }
}

TEST(ChooseMarks, NoTwoEllipsesOnAWildPathAreCloserThanTheirClearance) {
  Random random{7};
  std::vector<EstimatedPose> path;
  Eigen::Vector2d position{0, 0};
  for (int i = 0; i < 4000; ++i) {
    position += Eigen::Vector2d{random.normal(0, 0.1), random.normal(0, 0.1)};
    path.push_back(pose_at(i, position.x(), position.y(), std::abs(random.normal(0, 0.05))));
  }
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  ASSERT_THAT(marks.ellipses, SizeIs(Ge(5U)));
  for (std::size_t i = 0; i < marks.ellipses.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      const auto& a = marks.ellipses[i];
      const auto& b = marks.ellipses[k];
      EXPECT_GE((a.map_from_base.translation() - b.map_from_base.translation()).norm(),
                0.6 * kSpacing_px / kPxPerM);
      EXPECT_GT(a.time, b.time);
    }
  }
}

TEST(ChooseMarks, TheNumberOfMarksIsBounded) {
  std::vector<EstimatedPose> path = straight_path(400.0, 0.05);
  for (EstimatedPose& pose : path)
    pose.weak_axis = axis_along(1, 0, 0, WeakAxisSource::kOdometry);
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  EXPECT_THAT(marks.ellipses, SizeIs(AllOf(Ge(30U), Le(60U))));
  EXPECT_THAT(marks.weak_axes, SizeIs(AllOf(Ge(30U), Le(60U))));
}

TEST(ChooseMarks, MagnifiesSmallEllipsesOnly) {
  const auto magnification = [](double sigma_m) {
    return choose_marks(straight_path(9.0, sigma_m), kPxPerM, kSpacing_px).magnification;
  };
  EXPECT_EQ(magnification(0.0001), 50);
  EXPECT_EQ(magnification(0.02), 10) << "4 cm, 4 px: 5 times would be 20 px";
  EXPECT_EQ(magnification(0.2), 1);
  EXPECT_EQ(magnification(1e6), 1);
}

TEST(ChooseMarks, AFewLargeEllipsesLimitTheMagnification) {
  std::vector<EstimatedPose> path = straight_path(20.0, 0.001);
  for (std::size_t i = path.size() - 45; i < path.size(); ++i)
    path[i].covariance = covariance(0.2, 0.2);
  EXPECT_EQ(choose_marks(path, kPxPerM, kSpacing_px).magnification, 2);
}

TEST(ChooseMarks, EverySourceOfTheWeakAxisHasAMarkHoweverShortItsStretch) {
  std::vector<EstimatedPose> path = straight_path(40.0, 0.01);
  for (std::size_t i = 20; i < path.size(); ++i) {
    const bool by_odometry = i >= 195 && i < 201;
    path[i].weak_axis =
        axis_along(1, 0, 0, by_odometry ? WeakAxisSource::kOdometry : WeakAxisSource::kMarkers);
  }
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  EXPECT_THAT(marks.weak_axes, SizeIs(Ge(15U)));
  int by_odometry = 0;
  for (const EstimatedPose& pose : marks.weak_axes) {
    EXPECT_GE(pose.map_from_base.x(), 2.0 - 1e-9);
    by_odometry += pose.weak_axis->source == WeakAxisSource::kOdometry ? 1 : 0;
  }
  EXPECT_EQ(by_odometry, 1) << "a stretch of half a metre, too";
}

TEST(ChooseMarks, AnUnobservedAxisIsNeverHidden) {
  std::vector<EstimatedPose> path;
  for (const auto source :
       {WeakAxisSource::kMarkers, WeakAxisSource::kNothing, WeakAxisSource::kOdometry}) {
    EstimatedPose pose = pose_at(static_cast<int>(path.size()), 0.01, 0.0, 0.01);
    pose.weak_axis = axis_along(1, 0, 0, source);
    path.push_back(pose);
  }
  const auto marks = choose_marks(path, kPxPerM, kSpacing_px);
  ASSERT_THAT(marks.weak_axes, SizeIs(1));
  EXPECT_EQ(marks.weak_axes[0].weak_axis->source, WeakAxisSource::kNothing);
}

TEST(DrawEllipses, DrawsAnOutlineAndATintInside) {
  Sheet sheet;
  EstimatedPose pose = pose_at(0, 0, 0, 0);
  pose.covariance = covariance(0.2, 0.1);  // 2 sigma: 40 px by 20 px
  draw_ellipses(sheet.image, sheet.view, only(pose));

  EXPECT_TRUE(sheet.has(palette::kEllipse, 139, 100) || sheet.has(palette::kEllipse, 140, 100));
  EXPECT_TRUE(sheet.has(palette::kEllipse, 100, 119) || sheet.has(palette::kEllipse, 100, 120));
  EXPECT_NE(sheet.image(105, 110), (Colour{255, 255, 255})) << "tinted";
  EXPECT_FALSE(sheet.has(palette::kEllipse, 110, 105));
  const cv::Rect box = sheet.drawn_box();
  EXPECT_NEAR(box.width, 80, 5);
  EXPECT_NEAR(box.height, 40, 5);
  EXPECT_NEAR(box.x + box.width / 2.0, 100.0, 2.0);
}

TEST(DrawEllipses, ScalesByTheMagnification) {
  Sheet sheet;
  UncertaintyMarks marks = only(pose_at(0, 0, 0, 0.005));
  marks.magnification = 50;
  draw_ellipses(sheet.image, sheet.view, marks);
  EXPECT_NEAR(sheet.drawn_box().width, 100, 5);
}

TEST(DrawEllipses, AHugeEllipseDoesNotCoverThePanel) {
  Sheet sheet;
  for (const double sigma_m : {100.0, 1e9, 1e100})
    draw_ellipses(sheet.image, sheet.view, only(pose_at(0, 0, 0, sigma_m)));
  EXPECT_TRUE(sheet.is_blank()) << "the outline is far outside, and there is no tint";
}

TEST(DrawEllipses, DrawsNothingWithoutMarksOrForNan) {
  Sheet sheet;
  draw_ellipses(sheet.image, sheet.view, {});
  draw_ellipses(sheet.image, sheet.view, only(pose_at(0, kNan, 0, 0.1)));
  draw_ellipses(sheet.image, sheet.view, only(pose_at(0, 0, 0, kNan)));
  EXPECT_TRUE(sheet.is_blank());
}

TEST(DrawWeakAxes, DrawsABarAlongTheAxisInTheColourOfItsSource) {
  const std::vector<std::pair<WeakAxisSource, cv::Scalar>> colours{
      {WeakAxisSource::kOdometry, palette::kOdometry},
      {WeakAxisSource::kMarkers, palette::kMarker},
      {WeakAxisSource::kNothing, palette::kInk},
      {WeakAxisSource::kUnknown, palette::kFaintInk}};
  for (const auto& [source, colour] : colours) {
    Sheet along_x, along_y;
    EstimatedPose pose = pose_at(0, 0, 0, 0.1);
    pose.weak_axis = axis_along(1, 0, 0, source);  // 2 sigma: 20 px
    draw_weak_axes(along_x.image, along_x.view, only(pose));
    EXPECT_TRUE(along_x.has(colour, 100, 100));
    EXPECT_TRUE(along_x.has(colour, 115, 100));
    EXPECT_FALSE(along_x.has(colour, 100, 115));
    EXPECT_NEAR(along_x.drawn_box().width, 46, 6);

    pose.weak_axis = axis_along(0, 1, 0, source);
    draw_weak_axes(along_y.image, along_y.view, only(pose));
    EXPECT_TRUE(along_y.has(colour, 100, 115));
    EXPECT_FALSE(along_y.has(colour, 115, 100));
  }
}

TEST(DrawWeakAxes, WeakerAxesHaveLongerBarsWithinBounds) {
  int width_before_px = 0;
  for (const double information : {1e12, 100.0, 60.0, 0.0}) {
    Sheet sheet;
    EstimatedPose pose = pose_at(0, 0, 0, 0.1);
    pose.weak_axis = axis_along(1, 0, 0, WeakAxisSource::kOdometry, information);
    draw_weak_axes(sheet.image, sheet.view, only(pose));
    const int width_px = sheet.drawn_box().width;
    EXPECT_GT(width_px, width_before_px) << information;
    EXPECT_LT(width_px, 90);
    width_before_px = width_px;
  }
}

TEST(DrawWeakAxes, TheHeadingIsDrawnAsARing) {
  Sheet sheet;
  EstimatedPose pose = pose_at(0, 0, 0, 0.1);
  pose.weak_axis = axis_along(0, 0, 1, WeakAxisSource::kOdometry);
  draw_weak_axes(sheet.image, sheet.view, only(pose));
  EXPECT_FALSE(sheet.has(palette::kOdometry, 100, 100));
  EXPECT_TRUE(sheet.has(palette::kOdometry, 111, 100));
  EXPECT_TRUE(sheet.has(palette::kOdometry, 100, 111));
}

TEST(DrawWeakAxes, DrawsNothingWithoutAnAxisOrForNan) {
  Sheet sheet;
  EstimatedPose pose = pose_at(0, 0, 0, 0.1);
  draw_weak_axes(sheet.image, sheet.view, only(pose));
  for (const WeakAxis& wrong : {axis_along(kNan, 0, 0, WeakAxisSource::kOdometry),
                                axis_along(1, 0, 0, WeakAxisSource::kOdometry, kNan),
                                axis_along(1, 0, 0, WeakAxisSource::kOdometry, -1.0)}) {
    pose.weak_axis = wrong;
    draw_weak_axes(sheet.image, sheet.view, only(pose));
  }
  EXPECT_TRUE(sheet.is_blank());
}

TEST(DrawHealth, DrawsNothingWhileTrackingOrWithoutAPath) {
  Sheet sheet;
  draw_health(sheet.image, sheet.view, {}, 20);
  draw_health(sheet.image, sheet.view, straight_path(1.0, 0.1), 20);
  EXPECT_TRUE(sheet.is_blank());
}

TEST(DrawHealth, ASingleLostUpdateIsVisible) {
  Sheet sheet;
  std::vector<EstimatedPose> path = straight_path(0.9, 0.1);
  path[5].health = Health::kLost;
  draw_health(sheet.image, sheet.view, path, 20);
  EXPECT_TRUE(sheet.has(palette::kLost, 150, 100));
  EXPECT_NEAR(sheet.drawn_box().width, 20, 4);
  EXPECT_NEAR(sheet.drawn_box().height, 20, 4);
}

TEST(DrawHealth, APoseThatIsNotFiniteIsLeftOut) {
  Sheet sheet;
  EstimatedPose pose = pose_at(0, kNan, 0, 0.1);
  pose.health = Health::kLost;
  draw_health(sheet.image, sheet.view, {pose}, 20);
  EXPECT_TRUE(sheet.is_blank());
}

}  // namespace
}  // namespace waymark::viewer

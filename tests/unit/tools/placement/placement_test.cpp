// SPDX-License-Identifier: BSD-3-Clause
#include "placement/placement.hpp"

#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "placement/placement_report.hpp"
#include "placement/pose_covariance.hpp"
#include "placement/view_model.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <Eigen/LU>
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

namespace waymark::placement {
namespace {

using testing::Each;
using testing::IsEmpty;
using testing::Le;
using testing::Not;
using testing::SizeIs;

constexpr double kHalfWidth_m = 1.0;
constexpr double kCell_m = 0.05;
constexpr double kSpeed_mps = 0.1;

/// A corridor along x from 0 to `length_m`, walls at y = +-1 m, its ends closed or far away.
PlacedMapImage corridor(double length_m, bool is_closed) {
  PlacedMapImage image;
  image.resolution_m = kCell_m;
  image.origin_m = {-0.5 * kCell_m - 5.0, -0.5 * kCell_m - 1.5};
  image.width_px = static_cast<int>(std::lround((length_m + 10.0) / kCell_m)) + 1;
  image.height_px = 61;
  for (int row = 0; row < image.height_px; ++row) {
    for (int column = 0; column < image.width_px; ++column) {
      const double x_m = -5.0 + kCell_m * column;
      const double y_m = -1.5 + kCell_m * row;
      const bool is_side = std::abs(std::abs(y_m) - kHalfWidth_m) < 0.5 * kCell_m;
      const bool is_end =
          is_closed && (std::abs(x_m) < 0.5 * kCell_m || std::abs(x_m - length_m) < 0.5 * kCell_m);
      const bool is_inside = std::abs(y_m) < kHalfWidth_m;
      image.cells.push_back(is_side || (is_end && is_inside) ? Cell::kOccupied
                            : is_inside                      ? Cell::kFree
                                                             : Cell::kUnknown);
    }
  }
  return image;
}

/// A drive along the middle, 2 cm from scan to scan.
PlacementInput drive(double length_m, bool is_closed = false) {
  PlacementInput input;
  input.image = corridor(length_m, is_closed);
  input.config.robot.camera.focal_sigma = 1e-4;
  input.config.robot.camera.yaw_sigma_rad = 5e-4;
  constexpr double kApart_m = 0.02;
  for (double x_m = 1.0; x_m <= length_m - 1.0; x_m += kApart_m)
    input.places.push_back({(x_m - 1.0) / kSpeed_mps, {x_m, 0.0, 0.0}});
  return input;
}

MappedMarker on_left_wall(int id, double x_m) {
  return {id, 0, {x_m, kHalfWidth_m, -0.5 * std::numbers::pi}};
}

/// Sigma along the corridor at the end of each step, with those markers.
std::vector<double> sigmas(const PlacementInput& input) {
  constexpr double kNoTarget_m = 100.0;
  return place_markers(input, kNoTarget_m).advice.now_m;
}

TEST(Placement, AScanInABareCorridorHasNoInformationAlongIt) {
  const PlacementInput input = drive(20.0);
  std::vector<Eigen::Vector2d> hits;
  const ObservedAxes observed =
      predict_scan(OccupiedWalls{input.image}, {10.0, 0.2, 0.3}, input.config, hits);
  EXPECT_TRUE(observed.is_degenerate);
  const Eigen::Vector2d along{std::cos(0.3), -std::sin(0.3)};  // base axes
  EXPECT_NEAR(std::abs(observed.weak_direction.dot(along)), 1.0, 1e-3);
  const Eigen::Matrix2d position = observed.information.topLeftCorner<2, 2>();
  EXPECT_LT(along.dot(position * along), 1e-3 * position.trace());
  EXPECT_GT(position.trace(), 1e4);  // a centimetre, by one scan
  EXPECT_THAT(hits, Not(IsEmpty()));
}

TEST(Placement, AScanAtTheEndOfACorridorObservesEveryAxis) {
  const PlacementInput input = drive(20.0, true);
  std::vector<Eigen::Vector2d> hits;
  const OccupiedWalls walls{input.image};
  EXPECT_FALSE(predict_scan(walls, {18.0, 0.0, 0.0}, input.config, hits).is_degenerate);
  EXPECT_TRUE(predict_scan(walls, {10.0, 0.0, 0.0}, input.config, hits).is_degenerate);
}

TEST(Placement, WithoutMarkersSigmaGrowsWithTheRootOfTheDistance) {
  PlacementInput input = drive(26.0);
  input.config.slam.waymark.odometry.scale_sigma = 0.0;
  input.config.slam.waymark.learn_noise = false;
  const std::vector<double> sigma_m = sigmas(input);
  const double quarter_m = sigma_m[sigma_m.size() / 4];
  constexpr double kRounding = 0.03;  // rounding of the path to whole steps
  EXPECT_NEAR(sigma_m.back() / quarter_m, 2.0, kRounding * 2.0);
}

TEST(Placement, SigmaStaysWhereAMarkerIsInView) {
  PlacementInput input = drive(20.0);
  input.markers = {on_left_wall(0, 4.5)};
  const std::vector<double> sigma_m = sigmas(input);
  const std::vector<Step> steps =
      drive_along(input.places, OccupiedWalls{input.image}, input.config);
  for (std::size_t i = 1; i < steps.size(); ++i) {
    if (steps[i].map_from_base.x() >= 2.4) break;
    EXPECT_LT(sigma_m[i], 0.003) << "step " << i;
  }
  EXPECT_GT(sigma_m.back(), 0.01);
}

TEST(Placement, AMarkerNeverMakesSigmaLarger) {
  PlacementInput input = drive(20.0);
  const std::vector<double> without_m = sigmas(input);
  input.markers = {on_left_wall(0, 8.0)};
  const std::vector<double> with_m = sigmas(input);
  ASSERT_EQ(with_m.size(), without_m.size());
  for (std::size_t i = 0; i < with_m.size(); ++i)
    EXPECT_LE(with_m[i], 1.001 * without_m[i]) << "step " << i;
  EXPECT_LT(with_m.back(), 0.95 * without_m.back());
}

TEST(Placement, CovarianceOfMeasuredVariablesIsTheInverseOfTheirInformation) {
  Calibration sigmas = Calibration::Constant(0.1);
  PoseCovariance known{sigmas, 0.2};
  const Variable anchor{VariableKind::kKeyframe, 3};
  known.add(anchor, {{PoseCovariance::kPose, Eigen::Matrix3d::Identity()}},
            0.04 * Eigen::Matrix3d::Identity());
  const Variable other{VariableKind::kLandmark, 0};
  known.add(other, {{PoseCovariance::kPose, Eigen::Matrix3d::Identity()}},
            0.01 * Eigen::Matrix3d::Identity());
  const Eigen::MatrixXd jacobian_pose = Eigen::Vector3d{2.0, -1.0, 3.0}.asDiagonal();
  const Eigen::MatrixXd jacobian_anchor =
      (Eigen::Matrix3d{} << 1, 2, 0, 0, 1, 0, 4, 0, 1).finished();
  known.drop(anchor);
  known.add(anchor, {{PoseCovariance::kPose, Eigen::Matrix3d::Identity()}},
            0.04 * Eigen::Matrix3d::Identity());
  known.measure({{PoseCovariance::kPose, jacobian_pose}, {anchor, jacobian_anchor}});
  // Oracle: pose ~ 0.04, anchor - pose ~ 0.04, and the measurement, as one information matrix.
  Eigen::Matrix<double, 6, 6> information = Eigen::Matrix<double, 6, 6>::Zero();
  information.topLeftCorner<3, 3>().diagonal().array() += 1.0 / 0.04;
  Eigen::Matrix<double, 3, 6> rows;
  rows << -Eigen::Matrix3d::Identity(), Eigen::Matrix3d::Identity();
  information += rows.transpose() * rows / 0.04;
  rows << jacobian_pose, jacobian_anchor;
  information += rows.transpose() * rows;
  const Eigen::Matrix3d expected =
      Eigen::Matrix<double, 6, 6>{information.inverse()}.topLeftCorner<3, 3>();
  EXPECT_LT((known.of_pose() - expected).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Placement, PlacesLieOnWallsAndFaceTheRobot) {
  const PlacementInput input = drive(12.0, true);
  const OccupiedWalls walls{input.image};
  const std::vector<Step> steps = drive_along(input.places, walls, input.config);
  const std::vector<Se2> hung{on_left_wall(0, 6.0).map_from_marker};
  constexpr double kPlate_m = 0.6;
  const auto places = free_wall_places(steps, walls, hung, kPlate_m, 3.5, 0.5);
  ASSERT_THAT(places, testing::SizeIs(testing::Ge(30U)));
  for (const WallPlace& place : places) {
    const Eigen::Vector2d at = place.map_from_marker.translation();
    const Eigen::Vector2d facing = place.map_from_marker.rotation().col(0);
    const bool is_on_end = place.wall == "ahead" || place.wall == "behind";
    const double off_m = is_on_end ? std::min(std::abs(at.x()), std::abs(at.x() - 12.0))
                                   : std::abs(std::abs(at.y()) - kHalfWidth_m);
    EXPECT_LE(off_m, kCell_m) << at.transpose();
    EXPECT_GT(facing.dot(Eigen::Vector2d{6.0, 0.0} - at), 0.0) << at.transpose();
    EXPECT_FALSE(overlap(place.map_from_marker, hung.front(), kPlate_m)) << at.transpose();
    EXPECT_EQ(place.wall == "left", !is_on_end && at.y() > 0.0) << at.transpose();
  }
}

TEST(Placement, WithTheTargetMetNoMarkerIsAdvised) {
  PlacementInput input = drive(12.0);
  const Placement placement = place_markers(input, 1.0);
  EXPECT_TRUE(placement.is_met());
  EXPECT_THAT(placement.markers, IsEmpty());
  EXPECT_THAT(placement.stretches, IsEmpty());
}

TEST(Placement, AdvisedMarkersMeetTheTargetAndAllOfThemAreNeeded) {
  PlacementInput input = drive(16.0);
  input.markers = {on_left_wall(0, 4.0), on_left_wall(2, 12.0)};
  constexpr double kTarget_m = 0.015;
  const Placement placement = place_markers(input, kTarget_m);
  ASSERT_GT(placement.worst_now_m(), kTarget_m);
  ASSERT_TRUE(placement.is_met());
  ASSERT_THAT(placement.markers, Not(IsEmpty()));
  EXPECT_EQ(placement.markers.front().id, 1);  // the smallest free id
  // With the advised markers, the sigmas are those predicted; without one, the target is missed.
  for (const NewMarker& marker : placement.markers)
    input.markers.push_back({marker.id, 0, marker.place.map_from_marker});
  EXPECT_THAT(sigmas(input), Each(Le(kTarget_m)));
  for (std::size_t i = 0; i < placement.markers.size(); ++i) {
    PlacementInput fewer = input;
    fewer.markers.erase(fewer.markers.begin() + 2 + static_cast<std::ptrdiff_t>(i));
    EXPECT_THAT(sigmas(fewer), testing::Contains(testing::Gt(kTarget_m))) << "marker " << i;
  }
}

TEST(Placement, AnUnobservedScaleIsNamedAsTheLimit) {
  PlacementInput input = drive(16.0);
  input.config.robot.camera.focal_sigma = 0.02;
  const Placement placement = place_markers(input, 0.012);
  EXPECT_FALSE(placement.is_met());
  EXPECT_GT(placement.reachable_m(), 0.012);
  ASSERT_THAT(placement.limits, SizeIs(1));
  EXPECT_THAT(placement.limits.front().cause, testing::HasSubstr("focal_sigma"));
  EXPECT_LT(placement.limits.front().without_it_m, placement.reachable_m());
  EXPECT_THAT(placement_text(input, placement),
              testing::HasSubstr("No markers were found with which the target is met"));
}

TEST(Placement, IdsInUseAreNotReused) {
  PlacementInput input = drive(16.0);
  input.config.robot.markers.ids = {7, 3, 5};
  input.markers = {on_left_wall(3, 4.0)};
  const Placement placement = place_markers(input, 0.001);
  EXPECT_FALSE(placement.is_met());
  ASSERT_THAT(placement.markers, SizeIs(2));
  EXPECT_EQ(placement.markers[0].id, 5);
  EXPECT_EQ(placement.markers[1].id, 7);
  EXPECT_THAT(placement_csv(placement),
              testing::StartsWith("id,instance,x_m,y_m,yaw_rad,sigma_x_m"));
}

TEST(Placement, MarkersThatHangHighLeaveThePictureEarlier) {
  PlacementInput input = drive(12.0);
  const auto nearest_view_m = [&input](double height_m) {
    const ViewModel views{input.config, 8, height_m};
    double nearest_m = 10.0;
    for (double ahead_m = 5.0; ahead_m > 0.5; ahead_m -= 0.05)
      if (views.view({ahead_m, 0.3, std::numbers::pi}, {}, 0.0)) nearest_m = ahead_m;
    return nearest_m;
  };
  const double camera_m = input.config.robot.camera.z_m;
  EXPECT_LT(nearest_view_m(camera_m), 1.0);
  EXPECT_GT(nearest_view_m(camera_m + 1.0), 2.0);
}

TEST(Placement, TheReachableSigmaIsThatOfMarkersEverywhere) {
  PlacementInput input = drive(16.0);
  input.config.robot.camera.focal_sigma = 0.02;
  const Placement placement = place_markers(input, 0.012);
  ASSERT_FALSE(placement.is_met());
  EXPECT_EQ(placement.reachable_m(), placement.advice.everywhere_m);
  // Markers hung everywhere give the reported sigma.
  const OccupiedWalls walls{input.image};
  const std::vector<Step> steps = drive_along(input.places, walls, input.config);
  constexpr double kPlate_m = 0.6, kApart_m = 0.5;
  const auto places = free_wall_places(steps, walls, {}, kPlate_m, 3.5, kApart_m);
  for (const std::size_t place : everywhere(places))
    input.markers.push_back({static_cast<int>(place), 0, places[place].map_from_marker});
  EXPECT_NEAR(worst(sigmas(input)), placement.reachable_m(), 1e-9);
}

/// The row of a run 2 m long, with its own camera.
class PlacementRow : public ::testing::Test {
 protected:
  void SetUp() override {
    write("trajectory.tum", "0 0 0 0 0 0 0 1\n1 0.5 0 0 0 0 0 1\n");
    write("config.toml",
          "[robot.camera]\nfx_px = 777.0\nz_m = 0.2\n[slam]\nestimator = \"waymark\"\n");
    write("map.yaml",
          "image: map.pgm\nresolution: 0.05\norigin: [0.0, 0.0, 0.0]\nnegate: 0\n"
          "occupied_thresh: 0.65\nfree_thresh: 0.2\n");
    write("map.pgm", std::string{"P5\n2 1\n255\n"} + '\0' + '\xfe');
  }

  void write(const char* file, const std::string& text) const { folder_.file(file, text); }

  std::filesystem::path row() const { return folder_.path(); }

 private:
  evaluate::TemporaryFolder folder_;
};

TEST_F(PlacementRow, AGivenConfigurationOverridesThatOfTheRow) {
  write("slam.toml", "[slam]\nestimator = \"waymark\"\n[robot.camera]\nz_m = 0.3\n");
  const PlacementInput input = read_placement_input(row(), row() / "slam.toml");
  EXPECT_EQ(input.config.robot.camera.fx_px, 777.0);
  EXPECT_EQ(input.config.robot.camera.z_m, 0.3);
}

TEST_F(PlacementRow, MarkersHangAsHighAsTheLogSays) {
  EXPECT_FALSE(read_placement_input(row(), {}).marker_height_m);
  {
    LogWriter log{row() / "markers.lcm"};
    for (const double height_m : {1.4, 1.6, 9.0}) {
      MarkerDetections frame{.time = timestamp_from_us(1), .image_width_px = 640};
      frame.image_height_px = 480;
      frame.detections.resize(1);
      frame.detections[0].id = 7;
      frame.detections[0].covariance_in_base.setIdentity();
      frame.detections[0].base_from_marker.translation().z() = height_m;
      log.write(encode(channels::kMarkers, to_detections_message(frame)));
    }
    log.close();
  }
  EXPECT_EQ(read_placement_input(row(), {}).marker_height_m, 1.6);
}

TEST(Placement, SmallModulesAreDetectedRarely) {
  EXPECT_EQ(read_share_of(0.5), 0.0);
  EXPECT_EQ(read_share_of(4.0), 1.0);
  for (double module_px = 0.5; module_px < 4.0; module_px += 0.1)
    EXPECT_LE(read_share_of(module_px), read_share_of(module_px + 0.1));
}

TEST(Placement, AFolderThatIsNoRunIsRefusedInOneSentence) {
  EXPECT_THROW(read_placement_input("/nowhere.map.lcm", ""), std::runtime_error);
  EXPECT_THROW(read_placement_input(std::filesystem::temp_directory_path(), ""), SetupError);
}

}  // namespace
}  // namespace waymark::placement

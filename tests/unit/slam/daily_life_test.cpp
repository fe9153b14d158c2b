// SPDX-License-Identifier: BSD-3-Clause
// Whole drives: corrections, resumption at the last pose, changes of the map, and surveyed markers.
#include "common/files/whole_file.hpp"
#include "slam/last_pose.hpp"
#include "slam/survey_file.hpp"
#include "unit/slam/map_drives.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <map>

namespace waymark {
namespace {

using test::config_for;
using test::corridor_of;
using test::map_from_world;
namespace fs = std::filesystem;

template <class Type>
std::vector<Type> sent_on(Channel<Type> channel, const test::Drive& drive) {
  std::vector<Type> found;
  for (const Message& message : drive.messages)
    if (message.channel == channel.name) found.push_back(*decode<Type>(message.payload).message);
  return found;
}

Se2 odometry_at(const test::SensorLog& log, Timestamp time) {
  for (std::size_t i = 1; i < log.odometry.size(); ++i) {
    const OdometrySample& before = log.odometry[i - 1];
    const OdometrySample& after = log.odometry[i];
    if (after.time < time) continue;
    const auto sent = [](const OdometrySample& sample) {
      return to_odometry(to_pose_message(sample.time, sample.odom_from_base)).odom_from_base;
    };
    return interpolate(sent(before), sent(after),
                       to_seconds(time - before.time) / to_seconds(after.time - before.time));
  }
  return log.odometry.back().odom_from_base;
}

class DailyLife : public test::SavedMap {
 protected:
  void SetUp() override {
    folder_ = fs::path{::testing::TempDir()} / ("daily_" + std::to_string(::getpid()));
    fs::create_directories(folder_);
  }

  void TearDown() override { fs::remove_all(folder_); }

  fs::path folder_{};
};

TEST_F(DailyLife, TheCorrectionComposedWithOdometryIsTheEstimate) {
  const test::Drive drive = test::drive_through(SlamConfig{}, messages_of(*drive_));
  const auto corrections = sent_on(channels::kSlamCorrection, drive);
  ASSERT_EQ(corrections.size(), drive.estimates.size());
  for (std::size_t i = 0; i < corrections.size(); ++i) {
    const correction_t& correction = corrections[i];
    const slam_estimate_t& estimate = drive.estimates[i];
    ASSERT_EQ(correction.utime, estimate.utime);
    const Se2 odom_from_base = odometry_at(*drive_, timestamp_from_us(correction.utime));
    const Se2 pose = Se2{correction.x_m, correction.y_m, correction.theta_rad} * odom_from_base;
    EXPECT_NEAR(pose.x(), estimate.x_m, 1e-6);
    EXPECT_NEAR(pose.y(), estimate.y_m, 1e-6);
    EXPECT_NEAR(angle_difference(pose.theta(), estimate.theta_rad), 0.0, 1e-6);
    EXPECT_EQ(correction.map_id, estimate.map_id);
    EXPECT_NE(correction.map_id, 0);
  }
}

TEST_F(DailyLife, TheCorrectionsCovarianceTransformedToTheRobotIsThatOfTheEstimate) {
  const test::Drive drive = test::drive_through(SlamConfig{}, messages_of(*drive_, 0.0, 20.0));
  const correction_t correction = sent_on(channels::kSlamCorrection, drive).back();
  const slam_estimate_t& estimate = drive.estimates.back();
  using RowMajor3 = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  Eigen::Matrix3d carry = Eigen::Matrix3d::Identity();
  carry(0, 2) = -(estimate.y_m - correction.y_m);
  carry(1, 2) = estimate.x_m - correction.x_m;
  const Eigen::Matrix3d carried =
      carry * Eigen::Map<const RowMajor3>{correction.covariance} * carry.transpose();
  EXPECT_TRUE(carried.isApprox(Eigen::Map<const RowMajor3>{estimate.covariance}, 1e-6));
}

TEST_F(DailyLife, CorrectionsComeFromScansAndFromMarkers) {
  const test::Drive drive = test::drive_through(SlamConfig{}, messages_of(*drive_));
  std::map<int, int> counts;
  for (const correction_t& correction : sent_on(channels::kSlamCorrection, drive))
    ++counts[correction.reason];
  EXPECT_GT(counts[correction_t::REASON_SCAN], 20);
  EXPECT_GT(counts[correction_t::REASON_MARKER], 20);
}

TEST_F(DailyLife, ARestartedSlamContinuesAtItsLastPose) {
  const test::SensorLog today = test::drive(corridor_of(2));
  SlamConfig config = config_for(MapMode::kLocalise, *file_);
  config.slam.state_folder = folder_;
  test::drive_through(config, messages_of(today, 0.0, 21.0));
  config.slam.start.kind = StartKind::kLast;
  const test::Drive rest = test::drive_through(config, messages_of(today, 22.5));
  EXPECT_EQ(test::with_pose(rest), rest.estimates.size());
  EXPECT_LT(test::worst_error_m(rest, today, map_from_world(*drive_)), 0.1);
  // In another map it does not.
  write_last_pose(folder_, {timestamp_from_us(22'000'000), {99}, {}, {0.1, 0.1, 0.1}, {}});
  const test::Drive lost = test::drive_through(config, messages_of(today, 22.5));
  EXPECT_LT(test::worst_error_m(lost, today, map_from_world(*drive_)), 0.1);
}

// Slam is killed, so only the map that it saved during the run is left.
TEST_F(DailyLife, AKilledSlamContinuesWithTheMapThatItWasDrawing) {
  SlamConfig config = config_for(MapMode::kMap, folder_ / "unfinished.map.lcm");
  config.slam.state_folder = folder_;
  config.slam.start.kind = StartKind::kLast;
  config.slam.save_map_every_s = 5.0;
  {
    Inbox inbox;
    Outbox outbox;
    SlamNode killed{config, inbox, outbox};
    for (const Message& message : messages_of(*drive_, 0.0, 21.0))
      inbox.deliver(message);
  }
  const std::size_t num_saved = read_map_file(config.save_map).map.landmarks.size();
  const test::Drive rest = test::drive_through(config, messages_of(*drive_, 22.5));
  EXPECT_EQ(test::with_pose(rest), rest.estimates.size());
  EXPECT_LT(test::worst_error_m(rest, *drive_, map_from_world(*drive_)), 0.1);
  const std::size_t num_markers = corridor_of(1).markers.size();
  EXPECT_LT(num_saved, num_markers);
  EXPECT_EQ(read_map_file(config.save_map).map.landmarks.size(), num_markers);
}

// Ahead of the robot nothing is mapped, and there are no markers.
TEST_F(DailyLife, ARestartWithinSecondsNeedsNoConfirmationOfThePose) {
  test::SyntheticCorridor bare = corridor_of(1);
  bare.markers.clear();
  const test::SensorLog log = test::drive(bare);
  SlamConfig config = config_for(MapMode::kMap, folder_ / "bare.map.lcm");
  config.slam.state_folder = folder_;
  config.slam.start.kind = StartKind::kLast;
  test::drive_through(config, messages_of(log, 0.0, 21.0));
  const auto num_cells = [&] {
    return read_map_file(config.save_map).map.walls.sums().size();
  };
  const std::size_t num_saved = num_cells();
  const test::Drive rest = test::drive_through(config, messages_of(log, 22.5, 30.0));
  EXPECT_EQ(test::with_pose(rest), rest.estimates.size());
  EXPECT_GT(num_cells(), num_saved + num_saved / 10);
}

TEST_F(DailyLife, AMapWithoutTheLastPoseIsNotContinued) {
  SlamConfig config = config_for(MapMode::kMap, folder_ / "other.map.lcm");
  config.slam.state_folder = folder_;
  fs::copy_file(*file_, config.save_map);
  write_last_pose(folder_, {timestamp_from_us(1), {99}, {5.0, 0.0, 0.0}, {0.1, 0.1, 0.1}, {}});
  config.slam.start.kind = StartKind::kLast;
  const test::Drive drive = test::drive_through(config, messages_of(*drive_, 0.0, 5.0));
  ASSERT_FALSE(drive.estimates.empty());
  EXPECT_EQ(drive.estimates.front().has_pose, 1);
  EXPECT_NEAR(drive.estimates.front().x_m, 0.0, 0.05);
}

TEST_F(DailyLife, SavingPeriodicallyAndContinuingNeedAFile) {
  SlamConfig config;
  config.slam.save_map_every_s = 5.0;
  EXPECT_THROW(test::drive_through(config, {}), SetupError);
  config.slam.save_map_every_s = 0.0;
  config.slam.state_folder = folder_;
  config.slam.start.kind = StartKind::kLast;
  EXPECT_THROW(test::drive_through(config, {}), SetupError);
}

// One marker is gone, one was moved by a metre, one is new, and there is a new wall.
TEST_F(DailyLife, ChangesOfTheMapAreReported) {
  test::SyntheticCorridor changed = corridor_of(2);
  changed.markers[2].position_m.x() += 1.0;
  changed.markers.push_back(
      {77, {8.0, changed.markers[1].position_m.y()}, changed.markers[1].yaw_rad});
  const int gone = changed.markers[5].id;
  const int moved = changed.markers[2].id;
  changed.markers.erase(changed.markers.begin() + 5);
  changed.length_m = 13.0;
  changed.drive_m = 10.5;
  const test::Drive today = test::drive_through(config_for(MapMode::kLocalise, *file_),
                                                messages_of(test::drive(changed)));
  std::map<int, std::vector<int>> ids_of_kind;
  for (const map_change_t& change : today.changes)
    ids_of_kind[change.kind].push_back(change.id);
  EXPECT_EQ(ids_of_kind[map_change_t::KIND_MARKER_MISSING], std::vector{gone});
  EXPECT_EQ(ids_of_kind[map_change_t::KIND_MARKER_MOVED], std::vector{moved});
  EXPECT_EQ(ids_of_kind[map_change_t::KIND_MARKER_NEW], std::vector{77});
  ASSERT_EQ(ids_of_kind[map_change_t::KIND_WALL_NEW].size(), 1U);
  for (const map_change_t& change : today.changes)
    if (change.kind == map_change_t::KIND_WALL_NEW) {
      EXPECT_NEAR(change.x_m, 13.0 - 1.0, 0.2);  // the map begins at the robot's start
      EXPECT_GT(change.size_m, 1.0);
    }
}

TEST_F(DailyLife, ACorrectMapHasNoChanges) {
  const test::Drive today = test::drive_through(config_for(MapMode::kLocalise, *file_),
                                                messages_of(test::drive(corridor_of(2))));
  EXPECT_TRUE(today.changes.empty());
  EXPECT_FALSE(sent_on(channels::kSlamChanges, today).empty());
}

TEST_F(DailyLife, AMapOfAnotherBuildingIsReported) {
  const auto names_it = [](const test::SyntheticCorridor& corridor, MapMode mode) {
    const auto sent = sent_on(channels::kSlamFindings,
                              test::drive_through(config_for(mode, *file_, StartKind::kOrigin),
                                                  messages_of(test::drive(corridor))));
    const auto& found = sent.back().findings;
    return std::any_of(found.begin(), found.end(), [](const finding_t& finding) {
      return finding.name == "scans_contradict_loaded_map";
    });
  };
  test::SyntheticCorridor other = corridor_of(2);
  other.width_m = 3.0;
  for (const MapMode mode : {MapMode::kLocalise, MapMode::kExtend}) {
    EXPECT_FALSE(names_it(corridor_of(2), mode));
    EXPECT_TRUE(names_it(other, mode));
  }
}

// The other building shares nothing with the map but the configured start pose.
TEST_F(DailyLife, AMapIsNotExtendedInAnotherBuilding) {
  test::SyntheticCorridor other = corridor_of(2);
  other.width_m = 3.0;
  other.markers = test::opposite_markers(other, 3.5, 3.0);
  for (test::SyntheticMarker& marker : other.markers)
    marker.id += 100;
  SlamConfig config = config_for(MapMode::kExtend, *file_, StartKind::kOrigin);
  config.save_map = folder_ / "mixture.map.lcm";
  const test::Drive drive = test::drive_through(config, messages_of(test::drive(other)));
  EXPECT_TRUE(drive.failed);
  EXPECT_FALSE(fs::exists(config.save_map));
  EXPECT_EQ(drive.estimates.back().has_pose, 0);
}

// The other building has the same ids in pairs on its walls, which are as far apart.
TEST_F(DailyLife, AMapIsNotExtendedWhereMostOfItsMarkersHangElsewhere) {
  test::SyntheticCorridor other = corridor_of(2);
  other.markers = test::opposite_markers(other, 3.5, 2.2);
  SlamConfig config = config_for(MapMode::kExtend, *file_);
  config.save_map = folder_ / "mixture.map.lcm";
  const test::Drive drive = test::drive_through(config, messages_of(test::drive(other)));
  EXPECT_TRUE(drive.failed);
  EXPECT_FALSE(fs::exists(config.save_map));
  EXPECT_EQ(drive.estimates.back().health, slam_estimate_t::HEALTH_LOST);
}

// The markers mapped in this run stay its own, also when the robot returns to them.
TEST_F(DailyLife, MarkersOfThisRunDoNotConfirmTheLoadedMap) {
  test::SyntheticCorridor other = corridor_of(2);
  other.width_m = 4.0;
  other.length_m = 24.0;
  other.drive_m = 68.0;
  other.turn_back_every_m = 22.0;
  other.markers = test::opposite_markers(other, 3.5, 3.0);
  for (test::SyntheticMarker& marker : other.markers)
    marker.id += 100;
  const test::Drive drive = test::drive_through(
      config_for(MapMode::kLocalise, *file_, StartKind::kOrigin), messages_of(test::drive(other)));
  for (std::size_t i = drive.estimates.size() / 4; i < drive.estimates.size(); ++i)
    ASSERT_EQ(drive.estimates[i].has_pose, 0) << i;
}

class SurveyedMap : public DailyLife {
 protected:
  fs::path survey(const std::string& text) {
    const fs::path file = folder_ / "survey.csv";
    write_whole_file(file, text);
    return file;
  }

  std::string why_refused(const std::string& text) {
    try {
      read_survey(survey(text), "DICT_6X6_250");
    } catch (const SetupError& error) {
      return error.what();
    }
    return {};
  }

  static std::string line_of(const test::SyntheticMarker& marker, double off_m = 0.0) {
    return fmt::format("{},{},{},{},0.005,0.005,0.005\n", marker.id, marker.position_m.x() + off_m,
                       marker.position_m.y(), marker.yaw_rad);
  }

  static constexpr const char* kHeader = "id,x_m,y_m,yaw_rad,sigma_x_m,sigma_y_m,sigma_yaw_rad\n";
};

TEST_F(SurveyedMap, ErrorsInTheFileAreReportedWithTheirLine) {
  const std::string header = kHeader;
  const std::string good = header + "1,0,0,0,0.01,0.01,0.01\n";
  EXPECT_EQ(why_refused(good), "");
  const auto expect = [&](const std::string& text, const std::string& what) {
    EXPECT_NE(why_refused(text).find(what), std::string::npos) << why_refused(text);
  };
  expect(good + "1,3,0,0,0.01,0.01,0.01\n", "line 3: id 1 comes twice");
  expect(good + "2,3,0,0,0,0.01,0.01\n",
         "line 3: sigma_x_m is 0, but must be from 1e-06 to 1000000");
  expect(good + "2,3,0,0,1e-300,0.01,0.01\n", "line 3: sigma_x_m is 1e-300, but must be");
  expect(good + "2,3,0,0,-1,0.01,0.01\n", "line 3: sigma_x_m is -1");
  expect(good + "250,3,0,0,0.1,0.01,0.01\n", "line 3: id is 250, but the dictionary has 0 to 249");
  expect(good + "-1,3,0,0,0.1,0.01,0.01\n", "line 3: id is -1");
  expect(good + "2,nan,0,0,0.1,0.01,0.01\n", "line 3: x_m is 'nan', which is not a number");
  expect(good + "2,3,4500000,0,0.1,0.01,0.01\n",
         "line 3: y_m is 4500000, but poses are precise to a millimetre only up to 16384 m");
  expect(good + "2,3\n", "line 3: there is no y_m");
  expect("id,x_m\n1,2\n", "line 1: there is no column y_m");
  expect(header, "defines no frame");
  expect(header + "1,0,0,,0.01,0.01,\n", "defines no frame");
  expect("", "has no line with the names of its columns");
  EXPECT_THROW(read_survey(folder_ / "nowhere.csv", "DICT_6X6_250"), SetupError);
}

TEST_F(SurveyedMap, PosesAreInTheSurveysFrame) {
  const auto markers = corridor_of(1).markers;
  SlamConfig config;
  config.robot.markers.survey_file =
      survey(kHeader + line_of(markers.front()) + line_of(markers.back()));
  const test::Drive drive = test::drive_through(config, messages_of(*drive_));
  EXPECT_FALSE(drive.failed);
  EXPECT_GT(test::with_pose(drive), drive.estimates.size() * 3 / 4);
  EXPECT_LT(test::worst_error_m(drive, *drive_, Se2{}), 0.12);
  const auto trajectory = sent_on(channels::kSlamTrajectory, drive);
  ASSERT_FALSE(trajectory.empty());
  double squares_m2 = 0.0;
  for (const pose2D_t& pose : trajectory.front().poses) {
    const Se2 truth = test::true_pose(*drive_, pose.utime);
    squares_m2 += std::pow(double{pose.x} - truth.x(), 2) + std::pow(double{pose.y} - truth.y(), 2);
  }
  EXPECT_LT(std::sqrt(squares_m2 / static_cast<double>(trajectory.front().poses.size())), 0.02);
  EXPECT_TRUE(drive.changes.empty());
  EXPECT_EQ(drive.markers.size(), markers.size());
}

TEST_F(SurveyedMap, AMapThatIsNotInTheSurveysFrameIsNotSaved) {
  SlamConfig config;
  config.robot.markers.survey_file = survey(kHeader + std::string{"249,1,2,0,0.01,0.01,0.01\n"});
  config.save_map = folder_ / "unplaced.map.lcm";
  EXPECT_TRUE(test::drive_through(config, messages_of(*drive_)).failed);
  EXPECT_FALSE(fs::exists(config.save_map));
}

TEST_F(SurveyedMap, TwoContradictoryEntriesAreBothReportedAndTheMapStaysConsistent) {
  const auto markers = corridor_of(1).markers;
  const test::SyntheticMarker& first = markers.front();
  const test::SyntheticMarker& last = markers.back();
  SlamConfig config;
  config.robot.markers.survey_file = survey(
      fmt::format("id,x_m,y_m,sigma_x_m,sigma_y_m\n{},{},{},0.002,0.002\n{},{},{},0.002,0.002\n",
                  first.id, first.position_m.x(), first.position_m.y(), last.id,
                  last.position_m.x() + 1.0, last.position_m.y()));
  const test::Drive drive = test::drive_through(config, messages_of(*drive_));
  ASSERT_EQ(drive.changes.size(), 2U);
  EXPECT_GT(drive.changes[0].sigmas, 5.0);
  EXPECT_EQ(drive.estimates.back().health, slam_estimate_t::HEALTH_LOST);
  for (const marker_landmark_t& landmark : drive.markers) {
    const auto& marker = markers[static_cast<std::size_t>(landmark.id)];
    EXPECT_NEAR(landmark.x_m, marker.position_m.x(), 1.1) << landmark.id;
    EXPECT_NEAR(landmark.y_m, marker.position_m.y(), 0.3) << landmark.id;
  }
}

TEST_F(SurveyedMap, AWrongEntryIsReportedAndDoesNotDistortTheMap) {
  const auto markers = corridor_of(1).markers;
  for (const std::size_t wrong : {std::size_t{1}, markers.size() - 1}) {
    std::string text = kHeader;
    for (const std::size_t i :
         {std::size_t{0}, std::size_t{1}, markers.size() - 2, markers.size() - 1})
      text += line_of(markers[i], i == wrong ? 0.5 : 0.0);
    SlamConfig config;
    config.robot.markers.survey_file = survey(text);
    const test::Drive drive = test::drive_through(config, messages_of(*drive_));
    ASSERT_EQ(drive.changes.size(), 1U);
    EXPECT_EQ(drive.changes[0].kind, map_change_t::KIND_SURVEY_OFF);
    EXPECT_EQ(drive.changes[0].id, markers[wrong].id);
    EXPECT_GT(drive.changes[0].sigmas, 50.0);
    for (const marker_landmark_t& landmark : drive.markers) {
      const auto& marker = markers[static_cast<std::size_t>(landmark.id)];
      EXPECT_NEAR(landmark.x_m, marker.position_m.x(), 0.04) << landmark.id;
      EXPECT_NEAR(landmark.y_m, marker.position_m.y(), 0.04) << landmark.id;
    }
  }
}

}  // namespace
}  // namespace waymark

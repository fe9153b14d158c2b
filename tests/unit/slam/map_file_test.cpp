// SPDX-License-Identifier: BSD-3-Clause
// Maps that outlive the run: files, and runs that begin with one.
#include "slam/map_file.hpp"

#include "common/files/whole_file.hpp"
#include "common/log/log_file.hpp"
#include "common/random/random.hpp"
#include "map/map_merge.hpp"
#include "unit/slam/map_drives.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sys/wait.h>
#include <unistd.h>

#include <csignal>
#include <thread>

namespace waymark {
namespace {

using test::config_for;
using test::corridor_of;
using test::Drive;
using test::drive_through;
using test::map_from_world;
using test::SavedMap;
using test::with_pose;
using test::worst_error_m;

namespace fs = std::filesystem;

TEST_F(SavedMap, IsReadAsItWasWritten) {
  const MapFile map = read_map_file(*file_);
  EXPECT_EQ(map.map.landmarks.size(), corridor_of(1).markers.size());
  EXPECT_GT(map.map.graph.poses.size(), 50U);
  EXPECT_GE(map.map.graph.edges.size(), map.map.graph.poses.size() - 1);
  const fs::path copy = other_file("copy");
  EXPECT_EQ(write_map_file(copy, map.map, map.info), map.map.map_id);
  EXPECT_EQ(read_whole_file(copy), read_whole_file(*file_));
  fs::remove(copy);
}

TEST_F(SavedMap, ADamagedFileIsRefusedOrReadsTheSame) {
  const std::string whole = read_whole_file(*file_);
  const std::int64_t map_id = read_map_file(*file_).map.map_id;
  const fs::path damaged = other_file("damaged");
  Random random{7};
  constexpr int kPlaces = 1000;
  int refused = 0;
  for (int i = 0; i < kPlaces; ++i) {
    const auto place =
        static_cast<std::size_t>(random.uniform(0.0, 1.0) * static_cast<double>(whole.size() - 1));
    for (const bool is_cut : {true, false}) {
      std::string bytes = whole;
      if (is_cut)
        bytes.resize(place);
      else
        bytes[place] = static_cast<char>(bytes[place] ^ 0x10);
      write_whole_file(damaged, bytes);
      try {
        EXPECT_EQ(read_map_file(damaged).map.map_id, map_id);
        EXPECT_FALSE(is_cut) << "at " << place;
      } catch (const SetupError& error) {
        ++refused;
        EXPECT_NE(std::string{error.what()}.find(damaged.string()), std::string::npos);
      }
    }
  }
  EXPECT_GT(refused, 2 * kPlaces * 9 / 10);  // a log's event numbers are not the map's content
  fs::remove(damaged);
}

TEST_F(SavedMap, AFailedSaveLeavesNoPart) {
  const MapFile map = read_map_file(*file_);
  const fs::path full = other_file("full");
  const fs::path part = part_path_of(full);
  fs::create_symlink("/dev/full", part);
  EXPECT_THROW(write_map_file(full, map.map, map.info), std::runtime_error);
  EXPECT_FALSE(fs::is_symlink(part));
  EXPECT_FALSE(fs::exists(full));
}

TEST_F(SavedMap, ATileFarFromTheOthersIsRefused) {
  const fs::path stray = other_file("stray");
  LogReader reader{*file_};
  LogWriter writer{stray};
  while (const auto message = reader.next()) {
    auto tiles = decode<map_tiles_t>(message->payload);
    if (tiles.message)
      tiles.message->tiles.at(0).tile_x = tiles.message->tiles.at(0).tile_y = 1 << 19;
    writer.write(tiles.message ? encode(channels::kSlamMap, *tiles.message) : *message);
  }
  writer.close();
  try {
    read_map_file(stray);
    ADD_FAILURE() << "it was read";
  } catch (const SetupError& error) {
    EXPECT_NE(std::string{error.what()}.find("more tiles than a building has"), std::string::npos)
        << error.what();
  }
  fs::remove(stray);
}

TEST_F(SavedMap, AnotherFormatVersionIsRefused) {
  const MapFile map = read_map_file(*file_);
  std::vector<Message> messages = to_map_messages(map.map, map.info);
  map_header_t header = *decode<map_header_t>(messages.front().payload).message;
  header.format = map_header_t::FORMAT + 1;
  messages.front() = encode(channels::kMapHeader, header);
  const fs::path file = other_file("format");
  LogWriter writer{file};
  for (const Message& message : messages)
    writer.write(message);
  writer.close();
  try {
    read_map_file(file);
    FAIL() << "was read";
  } catch (const SetupError& error) {
    EXPECT_NE(
        std::string{error.what()}.find(fmt::format("format {}; this program reads {}",
                                                   map_header_t::FORMAT + 1, map_header_t::FORMAT)),
        std::string::npos);
  }
  fs::remove(file);
}

// Killed at any time, a writer leaves the old map or the new one.
TEST_F(SavedMap, IsWholeWhenItsWriterIsKilled) {
  const MapFile before = read_map_file(*file_);
  MapFile after = before;
  after.map.landmarks.pop_back();
  const fs::path file = other_file("killed");
  write_map_file(file, before.map, before.info);
  const std::int64_t new_id = [&] {
    const fs::path other = other_file("unkilled");
    const std::int64_t id = write_map_file(other, after.map, after.info);
    fs::remove(other);
    return id;
  }();
  Random random{11};
  for (int i = 0; i < 200; ++i) {
    const pid_t writer = ::fork();
    ASSERT_GE(writer, 0);
    if (writer == 0) {
      for (;;) {
        write_map_file(file, after.map, after.info);
        write_map_file(file, before.map, before.info);
      }
    }
    std::this_thread::sleep_for(
        std::chrono::microseconds{static_cast<std::int64_t>(random.uniform(0.0, 30'000.0))});
    ::kill(writer, SIGKILL);
    ::waitpid(writer, nullptr, 0);
    const std::int64_t found = read_map_file(file).map.map_id;
    EXPECT_TRUE(found == before.map.map_id || found == new_id) << i;
  }
  fs::remove(file);
  fs::remove(part_path_of(file));
}

TEST_F(SavedMap, ALaterRunLocalisesInIt) {
  const test::SensorLog today = test::drive(corridor_of(2));
  const std::string before = read_whole_file(*file_);
  const Drive localised = drive_through(config_for(MapMode::kLocalise, *file_), messages_of(today));
  EXPECT_GT(with_pose(localised), localised.estimates.size() * 9 / 10);
  EXPECT_LT(worst_error_m(localised, today, map_from_world(*drive_)), 0.06);
  EXPECT_EQ(read_whole_file(*file_), before);
  const MapFile map = read_map_file(*file_);
  ASSERT_EQ(localised.markers.size(), map.map.landmarks.size());
  for (std::size_t i = 0; i < localised.markers.size(); ++i)
    EXPECT_EQ(localised.markers[i].x_m, map.map.landmarks[i].map_from_marker.x());
  for (const slam_estimate_t& estimate : localised.estimates)
    EXPECT_EQ(estimate.map_id, map.map.map_id);
}

TEST_F(SavedMap, WithUnknownStartThereIsNoPoseBeforeAMarkerIsSeen) {
  test::SensorLog blind = test::drive(corridor_of(3));
  for (MarkerDetections& frame : blind.frames)
    frame.detections.clear();
  const Drive lost = drive_through(config_for(MapMode::kLocalise, *file_), messages_of(blind));
  EXPECT_EQ(with_pose(lost), 0U);
  EXPECT_TRUE(lost.failed);
  for (const slam_estimate_t& estimate : lost.estimates)
    EXPECT_EQ(estimate.health, slam_estimate_t::HEALTH_INITIALISING);
}

// All markers look alike: only the corridor's ends determine where the robot is.
TEST_F(SavedMap, AmongMarkersOfOneIdNoWrongPoseIsPublished) {
  test::SyntheticCorridor twins = corridor_of(4);
  for (test::SyntheticMarker& marker : twins.markers)
    marker.id = 5;
  const test::SensorLog mapping = test::drive(twins);
  const fs::path map = other_file("twins");
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, map), messages_of(mapping)).failed);
  twins.seed = 5;
  const test::SensorLog today = test::drive(twins);
  for (const double from_s : {0.0, 8.0, 16.0}) {
    const Drive found =
        drive_through(config_for(MapMode::kLocalise, map), messages_of(today, from_s));
    EXPECT_LT(worst_error_m(found, today, map_from_world(mapping)), 0.3) << "from " << from_s;
  }
  fs::remove(map);
}

TEST_F(SavedMap, ExtendingKeepsItsFrame) {
  const fs::path half = other_file("half");
  const fs::path whole = other_file("whole");
  const test::SensorLog today = test::drive(corridor_of(6));
  ASSERT_FALSE(
      drive_through(config_for(MapMode::kMap, half), messages_of(today, 0.0, 20.0)).failed);
  SlamConfig config = config_for(MapMode::kExtend, half);
  config.save_map = whole;
  const Drive rest = drive_through(config, messages_of(today, 15.0));
  EXPECT_LT(worst_error_m(rest, today, map_from_world(today)), 0.06);
  const MapFile first = read_map_file(half);
  const MapFile both = read_map_file(whole);
  EXPECT_EQ(both.map.parent_map_id, first.map.map_id);
  EXPECT_LT(first.map.landmarks.size(), both.map.landmarks.size());
  EXPECT_EQ(both.map.landmarks.size(), corridor_of(6).markers.size());
  for (const Landmark& landmark : both.map.landmarks) {
    const auto& markers = corridor_of(6).markers;
    const auto& marker = markers[static_cast<std::size_t>(landmark.id)];
    const Eigen::Vector2d truth = map_from_world(today) * marker.position_m;
    EXPECT_LT((landmark.map_from_marker.translation() - truth).norm(), 0.06) << landmark.id;
  }
  fs::remove(half);
  fs::remove(whole);
}

TEST_F(SavedMap, AMapOfAnotherConfigurationIsRefused) {
  SlamConfig config = config_for(MapMode::kLocalise, *file_);
  config.robot.markers.size_m = 0.2;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.grid.resolution_m = 0.1;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.mode = MapMode::kMap;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  config = config_for(MapMode::kLocalise, *file_);
  config.slam.estimator = EstimatorName::kGmapping;
  EXPECT_THROW(drive_through(config, {}), SetupError);
  EXPECT_THROW(drive_through(config_for(MapMode::kLocalise, other_file("nowhere")), {}),
               SetupError);
}

TEST_F(SavedMap, ATransformedMapLocalisesAtTheTransformedPose) {
  const MapFile map = read_map_file(*file_);
  const Se2 new_from_old{3.0, -2.0, 0.7};
  const fs::path file = other_file("turned");
  write_map_file(file, transformed(map.map, new_from_old), map.info);
  const test::SensorLog today = test::drive(corridor_of(2));
  const Drive localised = drive_through(config_for(MapMode::kLocalise, file), messages_of(today));
  EXPECT_GT(with_pose(localised), localised.estimates.size() * 9 / 10);
  EXPECT_LT(worst_error_m(localised, today, new_from_old * map_from_world(*drive_)), 0.06);
  fs::remove(file);
}

TEST_F(SavedMap, OverlappingMapsAreMerged) {
  const fs::path left = other_file("left");
  const fs::path right = other_file("right");
  const test::SensorLog day1 = test::drive(corridor_of(8));
  const test::SensorLog day2 = test::drive(corridor_of(9));
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, left), messages_of(day1, 0.0, 24.0)).failed);
  ASSERT_FALSE(drive_through(config_for(MapMode::kMap, right), messages_of(day2, 12.0)).failed);
  const MapFile a = read_map_file(left);
  const MapFile b = read_map_file(right);
  const auto alignment = align_by_markers(a.map, b.map);
  ASSERT_TRUE(alignment);
  EXPECT_GE(alignment->shared, 2U);
  const MapSnapshot both = merged(a.map, b.map, alignment->a_from_b);
  const std::vector<test::SyntheticMarker> markers = corridor_of(8).markers;
  EXPECT_EQ(both.landmarks.size(), markers.size());
  for (const Landmark& landmark : both.landmarks) {
    const auto& marker = markers.at(static_cast<std::size_t>(landmark.id));
    const Eigen::Vector2d truth = map_from_world(day1) * marker.position_m;
    EXPECT_LT((landmark.map_from_marker.translation() - truth).norm(), 0.08) << landmark.id;
  }
  fs::remove(left);
  fs::remove(right);
}

TEST_F(SavedMap, GlobalLocalisationInAnEmptyMapGivesNoPose) {
  MapSnapshot empty;
  empty.grid.frame = GridFrame::centred_on_map_origin(0.05);
  const fs::path file = other_file("empty");
  write_map_file(file, empty, read_map_file(*file_).info);
  EXPECT_THROW(drive_through(config_for(MapMode::kLocalise, file, StartKind::kAnywhere), {}),
               SetupError);
  fs::remove(file);
}

TEST(MapAlignment, NeedsTwoMarkersInCommon) {
  EXPECT_FALSE(align_by_markers(MapSnapshot{}, MapSnapshot{}));
}

}  // namespace
}  // namespace waymark

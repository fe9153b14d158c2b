// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/viewer_node.hpp"

#include "unit/viewer/drawn_scene.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <fstream>
#include <iterator>
#include <numbers>
#include <sstream>
#include <string>
#include <vector>

namespace waymark {
namespace {

namespace fs = std::filesystem;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsSupersetOf;
using ::testing::SizeIs;

slam_estimate_t estimate_at(double time_s, double x_m) {
  slam_estimate_t message{};
  message.has_pose = 1;
  message.utime = to_us(Timestamp{duration_from_seconds(time_s)});
  message.x_m = x_m;
  message.health = slam_estimate_t::HEALTH_TRACKING;
  return message;
}

map_tiles_t tile_at(int tile_x, int part, int num_parts) {
  map_tiles_t message{};
  message.part = part;
  message.num_parts = num_parts;
  message.resolution_m = 0.05;
  message.tile_size_cells = 2;
  message.num_tiles = 1;
  message.tiles.resize(1);
  message.tiles[0].tile_x = tile_x;
  message.tiles[0].num_cells = 4;
  message.tiles[0].occupancy = {0, 0, 100, 100};
  message.tiles[0].marker_ids = {-1, -1, 0, 0};
  return message;
}

trajectory_t trajectory_part(int part, int num_parts) {
  trajectory_t message{};
  message.utime = 10;
  message.part = part;
  message.num_parts = num_parts;
  message.num_poses = 1;
  message.poses.resize(1);
  message.poses[0] = pose2D_t{};
  message.poses[0].utime = part + 1;
  message.poses[0].x = 0.5F;
  return message;
}

class ViewerNodeTest : public ::testing::Test {
 protected:
  ViewerNodeTest() {
    fs::remove_all(folder_);
    config_.out_dir = folder_;
  }

  ~ViewerNodeTest() override { fs::remove_all(folder_); }

  template <class Type>
  void deliver(Channel<Type> channel, const Type& message) {
    inbox_.deliver(encode(channel, message));
  }

  std::string content_of(const std::string& name) const {
    std::ifstream stream{folder_ / name, std::ios::binary};
    return {std::istreambuf_iterator<char>{stream}, {}};
  }

  std::vector<std::string> names() const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator{folder_})
      names.push_back(entry.path().filename());
    return names;
  }

  const fs::path folder_ = fs::path{::testing::TempDir()} /
                           ::testing::UnitTest::GetInstance()->current_test_info()->name();
  ViewerConfig config_{};
  Inbox inbox_{};
  Outbox outbox_{};
};

TEST_F(ViewerNodeTest, NeedsAFolder) {
  config_.out_dir.clear();
  EXPECT_THROW((ViewerNode{config_, inbox_, outbox_}), SetupError);
}

TEST_F(ViewerNodeTest, WritesEveryFileAtTheEndEvenWithoutAMap) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  node.finish();
  EXPECT_THAT(names(),
              IsSupersetOf({"map.pgm", "map.yaml", "map.png", "marker_layer.png", "plain.png",
                            "trajectory.tum", "covariance.csv", "odometry.tum", "markers.csv"}));
  EXPECT_FALSE(node.failed());
}

TEST_F(ViewerNodeTest, LeavesTheFilesOfAnEarlierRunWhenNothingCameFromSlam) {
  ViewerNode node{config_, inbox_, outbox_};
  std::ofstream{folder_ / "map.pgm"} << "of an earlier run";
  deliver(channels::kOdometry, pose2D_t{});
  node.finish();
  EXPECT_THAT(names(), ElementsAre("map.pgm"));
  EXPECT_EQ(content_of("map.pgm"), "of an earlier run");
  EXPECT_FALSE(node.failed());
}

TEST_F(ViewerNodeTest, WritesDuringTheRunEveryPeriodOfMessageTime) {
  config_.viewer.write_period_s = 5.0;
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(100.0, 0.0));
  deliver(channels::kSlamEstimate, estimate_at(104.9, 0.5));
  EXPECT_EQ(content_of("trajectory.tum"), "");
  deliver(channels::kSlamEstimate, estimate_at(105.0, 1.0));
  EXPECT_THAT(content_of("trajectory.tum"), HasSubstr("105.000000 1.000000000"));
}

TEST_F(ViewerNodeTest, EveryPictureIsWrittenDuringTheRun) {
  config_.viewer.max_write_share = 1.0;
  ViewerNode node{config_, inbox_, outbox_};
  for (int i = 0; i <= 15; ++i)
    deliver(channels::kSlamEstimate, estimate_at(1.0 * i, 0.1 * i));
  EXPECT_THAT(names(), IsSupersetOf({"map.png", "marker_layer.png", "plain.png"}));
}

TEST_F(ViewerNodeTest, TheFinalFilesDoNotDependOnThePace) {
  const std::vector<std::string> files{"map.pgm",          "map.yaml",  "map.png",
                                       "marker_layer.png", "plain.png", "trajectory.tum",
                                       "covariance.csv"};
  std::vector<std::string> unpaced;
  for (const double share : {1.0, 0.001}) {
    config_.viewer.max_write_share = share;
    Inbox inbox;
    ViewerNode node{config_, inbox, outbox_};
    for (int i = 0; i <= 30; ++i) {
      inbox.deliver(encode(channels::kSlamMap, tile_at(i, 0, 1)));
      inbox.deliver(encode(channels::kSlamEstimate, estimate_at(1.0 * i, 0.1 * i)));
    }
    // With a share of a thousandth, only the first write is allowed.
    EXPECT_EQ(fs::exists(folder_ / "plain.png"), share == 1.0);
    node.finish();
    for (std::size_t i = 0; i < files.size(); ++i) {
      if (share == 1.0) unpaced.push_back(content_of(files[i]));
      EXPECT_TRUE(content_of(files[i]) == unpaced[i]) << files[i];
      fs::remove(folder_ / files[i]);
    }
  }
}

TEST_F(ViewerNodeTest, ATrajectoryHasOneLinePerEstimateWithoutRepeats) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  deliver(channels::kSlamEstimate, estimate_at(0.5, 0.0));
  deliver(channels::kSlamEstimate, estimate_at(1.2, 0.1));
  node.finish();
  const std::string text = content_of("trajectory.tum");
  EXPECT_EQ(std::count(text.begin(), text.end(), '\n'), 2);
  EXPECT_EQ(inbox_.counters().get("SLAM_ESTIMATE left out: not newer"), 2);
}

TEST_F(ViewerNodeTest, AssemblesTheMapFromPartsInAnyOrder) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamMap, tile_at(0, 1, 2));
  deliver(channels::kSlamMap, tile_at(-1, 0, 2));
  deliver(channels::kSlamMap, tile_at(-1, 0, 2));
  node.finish();
  EXPECT_EQ(content_of("map.pgm"),
            "P5\n4 2\n255\n" + std::string(4, '\0') + std::string(4, '\xFE'));
  EXPECT_THAT(content_of("map.yaml"), HasSubstr("origin: [-0.100000000, 0.000000000, 0.0]"));
}

TEST_F(ViewerNodeTest, WritesACompleteFinalTrajectory) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamTrajectory, trajectory_part(0, 2));
  node.finish();
  EXPECT_EQ(content_of("trajectory_final.tum"), "");
  deliver(channels::kSlamTrajectory, trajectory_part(1, 2));
  node.finish();
  EXPECT_EQ(content_of("trajectory_final.tum"),
            "0.000001 0.500000000 0.000000000 0 0 0 0.000000000000 1.000000000000\n"
            "0.000002 0.500000000 0.000000000 0 0 0 0.000000000000 1.000000000000\n");
  EXPECT_FALSE(node.failed());
}

TEST_F(ViewerNodeTest, AnIncompleteFinalTrajectoryIsNotWritten) {
  ViewerNode node{config_, inbox_, outbox_};
  std::ofstream{folder_ / "trajectory_final.tum"} << "of an earlier run";
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  deliver(channels::kSlamTrajectory, trajectory_part(1, 2));
  node.finish();
  EXPECT_FALSE(fs::exists(folder_ / "trajectory_final.tum"));
  EXPECT_EQ(inbox_.counters().get("SLAM_TRAJECTORY left out: an earlier part is missing"), 1);
}

pose_graph_t graph_part(int part, int num_parts) {
  pose_graph_t graph{};
  graph.part = part;
  graph.num_parts = num_parts;
  graph.num_vertices = 1;
  graph.vertices = {{1.0 * part, 2.0, 0.5}};
  if (part == 0) return graph;
  graph_edge_t edge{};
  edge.to_vertex = part;
  edge.pose[0] = 1.0;
  edge.pose[2] = 0.5 * std::numbers::pi;  // x of the first is -y of the second
  edge.information[0] = 100.0;
  edge.information[3] = 400.0;
  edge.information[5] = 900.0;
  graph.num_edges = 1;
  graph.edges = {edge};
  return graph;
}

TEST_F(ViewerNodeTest, WritesACompletePoseGraph) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  deliver(channels::kMapGraph, graph_part(0, 2));
  node.finish();
  EXPECT_FALSE(fs::exists(folder_ / "graph.g2o"));
  deliver(channels::kMapGraph, graph_part(1, 2));
  node.finish();
  std::istringstream text{content_of("graph.g2o")};
  std::vector<std::string> lines;
  for (std::string line; std::getline(text, line);)
    lines.push_back(line);
  ASSERT_EQ(lines.size(), 4U);
  EXPECT_EQ(lines[0], "VERTEX_SE2 0 0 2 0.5");
  EXPECT_EQ(lines[1], "VERTEX_SE2 1 1 2 0.5");
  EXPECT_EQ(lines[2], "FIX 0");
  std::istringstream edge{lines[3]};
  std::string word;
  edge >> word;
  EXPECT_EQ(word, "EDGE_SE2");
  const double expected[] = {0, 1, 1, 0, 0.5 * std::numbers::pi, 400, 0, 0, 100, 0, 900};
  for (const double number : expected) {
    double written = 0.0;
    edge >> written;
    EXPECT_NEAR(written, number, 1e-7);
  }
}

TEST_F(ViewerNodeTest, AFileThatCannotBeWrittenIsAFailureAndTheOthersAreWritten) {
  ViewerNode node{config_, inbox_, outbox_};
  fs::create_directories(folder_ / "map.yaml" / "in the way");
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  node.finish();
  EXPECT_TRUE(node.failed());
  EXPECT_THAT(content_of("trajectory.tum"), HasSubstr("1.000000 "));
}

// Slam was restarted: its map has another id and another frame.
TEST_F(ViewerNodeTest, AnotherMapIdStartsNewFilesAndKeepsTheEarlierOnesInAFolder) {
  ViewerNode node{config_, inbox_, outbox_};
  slam_estimate_t estimate = estimate_at(1.0, 7.0);
  estimate.map_id = 0xab;
  deliver(channels::kSlamEstimate, estimate);
  map_tiles_t tiles = tile_at(3, 0, 1);
  tiles.utime = 1'000'000;
  tiles.map_id = 0xab;
  deliver(channels::kSlamMap, tiles);
  estimate = estimate_at(2.0, 0.5);
  estimate.map_id = 0xcd;
  deliver(channels::kSlamEstimate, estimate);
  deliver(channels::kSlamMap, tiles);  // a late message of the map before
  node.finish();
  EXPECT_THAT(content_of("trajectory.tum"), HasSubstr("2.000000 0.5"));
  EXPECT_EQ(content_of("trajectory.tum").find("7.0"), std::string::npos);
  EXPECT_THAT(content_of("map-00000000000000ab/trajectory.tum"), HasSubstr("1.000000 7.0"));
  EXPECT_NE(content_of("map-00000000000000ab/map.pgm"), content_of("map.pgm"));
}

TEST_F(ViewerNodeTest, AnotherMapIsFollowedAfterTheClockWasSetBack) {
  ViewerNode node{config_, inbox_, outbox_};
  slam_estimate_t estimate = estimate_at(1000.0, 7.0);
  estimate.map_id = 0xab;
  deliver(channels::kSlamEstimate, estimate);
  for (int i = 0; i < 30; ++i) {
    estimate = estimate_at(100.0 + i, 0.5);
    estimate.map_id = 0xcd;
    deliver(channels::kSlamEstimate, estimate);
  }
  node.finish();
  EXPECT_THAT(content_of("trajectory.tum"), HasSubstr("129.000000 0.5"));
}

TEST_F(ViewerNodeTest, FilesOfAnEarlierRunThatThisRunDoesNotWriteAreRemoved) {
  ViewerNode node{config_, inbox_, outbox_};
  const std::vector<std::string> stale{"changes.csv",    "findings.json",  "scan.png",
                                       "trajectory.tum", "covariance.csv", "odometry.tum"};
  for (const std::string& name : stale)
    std::ofstream{folder_ / name} << "of an earlier run";
  deliver(channels::kSlamMap, tile_at(0, 0, 1));
  node.finish();
  EXPECT_TRUE(fs::exists(folder_ / "map.pgm"));
  for (const std::string& name : stale)
    EXPECT_FALSE(fs::exists(folder_ / name)) << name;
}

/// Maps one after the other, with an estimate each.
void deliver_maps(Inbox& inbox, std::int64_t count) {
  for (std::int64_t id = 1; id <= count; ++id) {
    slam_estimate_t estimate = estimate_at(static_cast<double>(id), 0.0);
    estimate.map_id = id;
    inbox.deliver(encode(channels::kSlamEstimate, estimate));
  }
}

TEST_F(ViewerNodeTest, AMapThatCannotBeArchivedIsAFailure) {
  ViewerNode node{config_, inbox_, outbox_};
  std::ofstream{folder_ / "map-0000000000000001"} << "in the way";
  deliver_maps(inbox_, 2);
  EXPECT_TRUE(node.failed());
}

TEST_F(ViewerNodeTest, AFileThatCannotBeArchivedIsAFailure) {
  ViewerNode node{config_, inbox_, outbox_};
  fs::create_directories(folder_ / "map-0000000000000001" / "map.yaml" / "in the way");
  deliver_maps(inbox_, 2);
  EXPECT_TRUE(node.failed());
  EXPECT_THAT(content_of("map-0000000000000001/trajectory.tum"), HasSubstr("1.000000 "));
}

TEST_F(ViewerNodeTest, AMapTooLargeForItsFilesIsAFailure) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamMap, tile_at(0, 0, 1));
  deliver(channels::kSlamMap, tile_at(400'000, 0, 1));
  node.finish();
  EXPECT_FALSE(node.failed()) << "1.6 million cells";
  map_tiles_t far = tile_at(0, 0, 1);
  far.tiles[0].tile_y = 20;
  deliver(channels::kSlamMap, far);
  node.finish();
  EXPECT_TRUE(node.failed());
  EXPECT_TRUE(content_of("map.pgm").starts_with("P5\n800002 2\n"));
}

TEST_F(ViewerNodeTest, WritesChangesOfTheMap) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  map_changes_t changes{};
  changes.utime = 1'000'000;
  changes.num_changes = 2;
  changes.changes.resize(2, map_change_t{});
  changes.changes[0].kind = map_change_t::KIND_MARKER_MISSING;
  changes.changes[0].id = 7;
  changes.changes[0].x_m = 1.5;
  changes.changes[0].support = 9;
  changes.changes[1].kind = map_change_t::KIND_WALL_GONE;
  changes.changes[1].id = -1;
  changes.changes[1].size_m = 0.9;
  deliver(channels::kSlamChanges, changes);
  node.finish();
  EXPECT_EQ(content_of("changes.csv"),
            "change,id,instance,x_m,y_m,yaw_rad,was_x_m,was_y_m,size_m,sigmas,support\n"
            "marker_missing,7,0,1.500000,0.000000,0.000000,0.000000,0.000000,0.000,0.0,9\n"
            "wall_gone,-1,0,0.000000,0.000000,0.000000,0.000000,0.000000,0.900,0.0,0\n");
}

TEST_F(ViewerNodeTest, WritesTheFindingsAboutSensors) {
  ViewerNode node{config_, inbox_, outbox_};
  deliver(channels::kSlamEstimate, estimate_at(1.0, 0.0));
  findings_t findings{};
  findings.utime = 1'000'000;
  findings.num_findings = 2;
  findings.findings.resize(2, finding_t{});
  findings.findings[0] = {"range_noise_scale", "ranges \"scatter\"", 2.5, -1.0};
  findings.findings[1] = {"odometry_stuck", "it stood still", 20.0, 0.5};
  deliver(channels::kSlamFindings, findings);
  node.finish();
  const auto json = nlohmann::json::parse(content_of("findings.json"));
  EXPECT_EQ(json["range_noise_scale"]["value"], 2.5);
  EXPECT_TRUE(json["range_noise_scale"]["share"].is_null());
  EXPECT_EQ(json["range_noise_scale"]["text"], "ranges \"scatter\"");
  EXPECT_EQ(json["odometry_stuck"]["share"], 0.5);
}

}  // namespace
}  // namespace waymark

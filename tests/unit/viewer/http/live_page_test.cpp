// SPDX-License-Identifier: BSD-3-Clause
#include "common/errors/setup_error.hpp"
#include "viewer/http/health_text.hpp"
#include "viewer/http/http_address.hpp"
#include "viewer/http/live_feed.hpp"
#include "viewer/http/page_json.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

#include <thread>

namespace waymark::viewer {
namespace {

using ::testing::EndsWith;
using ::testing::HasSubstr;
using ::testing::Not;
using ::testing::SizeIs;
using Json = nlohmann::json;

Timestamp at_s(double time_s) {
  return Timestamp{duration_from_seconds(time_s)};
}

TEST(HttpAddress, IsHostAndPort) {
  EXPECT_EQ(parse_http_address("127.0.0.1:8080").url(), "http://127.0.0.1:8080/");
  EXPECT_EQ(parse_http_address(":80").host, "127.0.0.1");
  EXPECT_EQ(parse_http_address("[::1]:8080").url(), "http://[::1]:8080/");
  EXPECT_TRUE(parse_http_address("[::1]:8080").is_loopback());
  EXPECT_TRUE(parse_http_address("localhost:8080").is_loopback());
  EXPECT_FALSE(parse_http_address("0.0.0.0:8080").is_loopback());
  EXPECT_FALSE(parse_http_address("127.example.org:8080").is_loopback());
}

TEST(HttpAddress, RefusesTextThatIsNotHostAndPort) {
  for (const auto* text : {"", "8080", "localhost", "a:0", "a:65536", "a:-1", "a:80x", "a b:80",
                           "::1:80", "http://a:80", "[]:80", "a:"})
    EXPECT_THROW(parse_http_address(text), SetupError) << text;
}

TEST(HttpAddress, ANameOfAnotherSiteIsNotThisMachine) {
  for (const auto* host : {"localhost", "localhost:8080", "127.0.0.1:1", "[::1]:8080"})
    EXPECT_TRUE(names_loopback(host)) << host;
  for (const auto* host : {"", "robot", "localhost.evil.example:8080", "127.evil.example:8080",
                           "127.0.0.1.evil.example", "[127.evil.example]", "[", "[::2]:1", ":80"})
    EXPECT_FALSE(names_loopback(host)) << host;
}

class HealthText : public ::testing::Test {
 protected:
  HealthText() {
    view_.time = at_s(100.0);
    view_.estimate = EstimatedPose{.time = view_.time, .health = Health::kTracking};
    view_.last_camera = view_.time;
    view_.last_marker = view_.time;
  }

  LiveView view_{};
};

TEST_F(HealthText, NamesWhatObservesTheWeakAxis) {
  EXPECT_EQ(health_reason(view_), "The walls fix the position in every direction.");
  view_.estimate->weak_axis = WeakAxis{.direction = {1, 0, 0}, .source = WeakAxisSource::kMarkers};
  EXPECT_THAT(health_reason(view_), EndsWith("markers measure it."));
  view_.estimate->weak_axis->source = WeakAxisSource::kOdometry;
  EXPECT_THAT(health_reason(view_), HasSubstr("only odometry measures it"));
  view_.estimate->weak_axis->direction = {0, 0, 1};
  EXPECT_THAT(health_reason(view_), HasSubstr("how the robot is turned"));
  view_.estimate->health = Health::kLost;
  EXPECT_EQ(health_reason(view_), "What the sensors see does not fit the map at this place.");
}

TEST_F(HealthText, ShowsHowLongTheCameraOrMarkersHaveBeenMissing) {
  view_.last_marker = at_s(88.0);
  EXPECT_THAT(health_reason(view_), EndsWith(" No marker for 12 s."));
  view_.last_camera = at_s(91.0);
  EXPECT_THAT(health_reason(view_), EndsWith(" The camera has been silent for 9 s."));
  view_.last_camera = view_.last_marker = std::nullopt;
  EXPECT_THAT(health_reason(view_), EndsWith(" No marker so far."));
}

TEST_F(HealthText, SaysWhenTheScanDoesNotFitOrSlamSendsNothing) {
  view_.estimate->health = Health::kLost;
  EXPECT_THAT(health_reason(view_), HasSubstr("does not fit the map"));
  view_.estimate.reset();
  EXPECT_EQ(health_reason(view_), "Nothing has come from slam yet.");
}

TEST_F(HealthText, SaysThatSlamIsSilentInsteadOfItsLastHealth) {
  view_.silences = {.slam_s = 0.5, .estimate_s = 0.5, .lidar_s = 0.5, .odometry_s = 0.5};
  EXPECT_EQ(health_name(view_), "tracking");
  view_.silences = {.slam_s = 7.0, .estimate_s = 7.2, .lidar_s = 0.5, .odometry_s = 0.5};
  EXPECT_EQ(health_name(view_), "silent");
  EXPECT_EQ(health_reason(view_), "Slam has been silent for 7 s: it has ended, or hangs.");
  view_.silences.slam_s = 0.5;
  view_.silences.odometry_s = 8.0;
  EXPECT_EQ(health_name(view_), "silent");
  EXPECT_EQ(health_reason(view_),
            "Slam has sent no pose for 7 s. ODOMETRY has been silent for 8 s.");
  view_.silences = {.slam_s = 0.1, .estimate_s = 0.1, .lidar_s = 3.0, .odometry_s = 0.1};
  EXPECT_EQ(health_name(view_), "tracking");
  EXPECT_THAT(health_reason(view_), EndsWith(" LIDAR has been silent for 3 s."));
}

ViewPtr view_at(double time_s, std::uint64_t number) {
  LiveView view;
  view.time = at_s(time_s);
  view.number = number;
  return std::make_shared<LiveView>(view);
}

TEST(ViewStore, KeepsAnEvenHistoryOfBoundedSize) {
  ViewStore views;
  for (int i = 0; i <= 10'000; ++i)
    views.post(view_at(i, static_cast<std::uint64_t>(i) + 1), {});
  EXPECT_EQ(views.history().last, at_s(10'000));
  for (double time_s = 0.0; time_s <= 10'000.0; time_s += 123.4) {
    const double shown_s = to_seconds(views.at(at_s(time_s))->time);
    EXPECT_LE(shown_s, time_s);
    // Evenly spread, the sparsest history of 10 000 s has half the largest number of views.
    EXPECT_GT(shown_s, time_s - 2.0 * 10'000.0 / ViewStore::kMaxHistory - 1.0);
  }
}

TEST(ViewStore, TheHistoryBeginsWithTheFirstStampNotWithTime0) {
  ViewStore views;
  for (const double time_s : {0.0, 0.0, 1234.0, 1235.0})
    views.post(view_at(time_s, 1), {});
  EXPECT_EQ(views.history().first, at_s(1234.0));
}

TEST(ViewStore, WaitsUntilThereIsANewerView) {
  ViewStore views;
  EXPECT_EQ(views.wait_for_newer(0, std::chrono::milliseconds{1}), nullptr);
  views.post(view_at(1.0, 7), {});
  EXPECT_EQ(views.wait_for_newer(6, std::chrono::milliseconds{1})->number, 7U);
  EXPECT_EQ(views.wait_for_newer(7, std::chrono::milliseconds{1}), nullptr);
}

map_tiles_t tile(int x, std::int8_t occupancy, double origin_x_m = 0.0) {
  map_tiles_t message{};
  message.num_parts = 1;
  message.origin_x_m = origin_x_m;
  message.resolution_m = 0.05;
  message.tile_size_cells = 2;
  message.num_tiles = 1;
  message.tiles.resize(1);
  message.tiles[0].tile_x = x;
  message.tiles[0].num_cells = 4;
  message.tiles[0].occupancy.assign(4, occupancy);
  message.tiles[0].marker_ids.assign(4, -1);
  return message;
}

constexpr std::size_t kHeaderBytes = 40;
constexpr std::size_t kTileBytes = 8 + 4;

TEST(LiveFeed, OnlyChangedTilesAreSent) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kMessageTime};
  feed.add(tile(0, 10));
  feed.add(tile(1, 20));
  feed.post_last();
  const std::uint32_t version = views.newest()->map->version;
  EXPECT_THAT(tile_bytes(*views.newest()->map, 0), SizeIs(kHeaderBytes + 2 * kTileBytes));
  feed.add(tile(0, 10));
  feed.post_last();
  EXPECT_THAT(tile_bytes(*views.newest()->map, version), SizeIs(kHeaderBytes));
  feed.add(tile(1, 99));
  feed.post_last();
  const std::string bytes = tile_bytes(*views.newest()->map, version);
  ASSERT_THAT(bytes, SizeIs(kHeaderBytes + kTileBytes));
  EXPECT_EQ(bytes.substr(bytes.size() - 4), std::string(4, 99));
}

TEST(LiveFeed, AnotherTileLayoutStartsANewMap) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kMessageTime};
  feed.add(tile(0, 10));
  feed.post_last();
  const std::uint32_t generation = views.newest()->map->generation;
  feed.add(tile(1, 20, 5.0));
  feed.post_last();
  EXPECT_NE(views.newest()->map->generation, generation);
  EXPECT_THAT(views.newest()->map->tiles, SizeIs(1));
}

TEST(LiveFeed, ShowsTheStateAtAGivenTimeOfALog) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kMessageTime};
  for (int i = 0; i <= 100; ++i) {
    slam_estimate_t message{};
    message.has_pose = 1;
    message.markers_in_view = i == 40 ? 1 : 0;
    feed.add(message, {.time = at_s(i), .map_from_base = {0.1 * i, 0.0, 0.0}});
  }
  const auto json = Json::parse(view_json(*views.at(at_s(50.5)), views.history()));
  EXPECT_EQ(json["time_s"], 50.0);
  EXPECT_EQ(json["since_marker_s"], 10.0);
  EXPECT_EQ(json["estimate"]["pose"][0], 5.0);
  EXPECT_EQ(json["path_length"], 51);
  EXPECT_EQ(json["history_s"], Json::parse("[0.0, 100.0]"));
}

TEST(LiveFeed, FollowsAClockThatIsSetBack) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kMessageTime};
  for (int i = 0; i < 10; ++i)
    feed.add_markers(at_s(1000.0 + i), {});
  feed.add_markers(at_s(9000.0), {});
  EXPECT_EQ(views.newest()->time, at_s(1009.0)) << "one stamp is wrong";
  for (int i = 0; i < 30; ++i)
    feed.add_markers(at_s(500.0 + i), {});
  EXPECT_EQ(views.newest()->time, at_s(529.0));
}

TEST(LiveFeed, WhenTheClockIsSetTheTimesSinceMarkerAndCameraGoOn) {
  for (const double step_s : {-900.0, 3600.0}) {
    ViewStore views;
    LiveFeed feed{views, "run", LiveFeed::Pace::kMessageTime};
    slam_estimate_t with_marker{};
    with_marker.has_pose = 1;
    with_marker.markers_in_view = 1;
    feed.add(with_marker, {.time = at_s(1000.0)});
    marker_detections_t detections{};
    for (int i = 1; i <= 60; ++i) {
      const double time_s = 1000.0 + 0.1 * i + (i > 20 ? step_s : 0.0);
      feed.add_markers(at_s(time_s), {});
      detections.utime = to_us(at_s(time_s));
      if (i == 25) feed.add(detections);
    }
    feed.post_last();
    const LiveView& view = *views.newest();
    EXPECT_NEAR(*seconds_since(view.last_marker, view.time), 6.0, 0.2) << step_s;
    EXPECT_NEAR(*seconds_since(view.last_camera, view.time), 3.5, 0.2) << step_s;
  }
}

TEST(LiveFeed, UpdatesWithoutMessagesWhenItIsToldOfSilence) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kWallClock};
  feed.note_silences({.slam_s = 3.0, .estimate_s = 3.0});
  ASSERT_NE(views.newest(), nullptr);
  EXPECT_EQ(health_name(*views.newest()), "silent");
}

TEST(LiveFeed, UpdatesSlowlyWithoutClients) {
  ViewStore views;
  LiveFeed feed{views, "run", LiveFeed::Pace::kWallClock};
  const auto number_after_300_ms = [&] {
    std::this_thread::sleep_for(std::chrono::milliseconds{300});
    feed.add_markers(at_s(1.0), {});
    return views.wait_for_newer(0, std::chrono::milliseconds{1})->number;
  };
  feed.add_markers(at_s(1.0), {});
  std::this_thread::sleep_for(std::chrono::milliseconds{300});
  feed.add_markers(at_s(1.0), {});  // no view is due, as no client reads
  EXPECT_FALSE(views.is_watched());
  EXPECT_EQ(views.newest()->number, 1U);
  EXPECT_TRUE(views.is_watched());
  EXPECT_EQ(number_after_300_ms(), 2U);
  EXPECT_EQ(number_after_300_ms(), 3U);
}

TEST(PageJson, APathIsPartOfTheView) {
  const LiveView view;
  const std::vector<PathPoint> growth{{1.0F, 2.5F}, {3.0F, 4.0F}};
  auto json = Json::parse(with_path(view_json(view, {}), 7, growth));
  EXPECT_EQ(json["path"], Json::parse(R"({"first": 7, "xy": [1.0, 2.5, 3.0, 4.0]})"));
  json.erase("path");
  EXPECT_EQ(json, Json::parse(view_json(view, {})));
}

TEST(PageJson, IsJsonWhateverTheStringsAndNumbers) {
  LiveView view;
  view.title = "\xff\"</script>";
  view.estimate = EstimatedPose{};
  view.estimate->covariance.setConstant(std::numeric_limits<double>::quiet_NaN());
  view.estimate->map_from_base = {std::numeric_limits<double>::infinity(), 0.0, 0.0};
  const auto json = Json::parse(view_json(view, {}));
  EXPECT_TRUE(json["estimate"]["covariance_xy"][0].is_null());
  EXPECT_TRUE(json["estimate"]["pose"][0].is_null());
}

}  // namespace
}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
#include "viewer/core/scene/change_monitor.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace waymark::viewer {
namespace {

using ::testing::ElementsAre;
using ::testing::IsEmpty;

EstimatedPose estimate(double time_s, Health health) {
  return {.time = Timestamp{duration_from_seconds(time_s)},
          .map_from_base = {time_s, -1.0, 0.0},
          .health = health};
}

Landmark landmark(int id, int instance, LandmarkState state) {
  return {.id = id, .instance = instance, .map_from_marker = {1.0 * id, 2.0, 0.0}, .state = state};
}

Change note(const std::string& text) {
  return {Change::Kind::kNote, text};
}

Change alarm(const std::string& text) {
  return {Change::Kind::kAlarm, text};
}

constexpr Timestamp kNow{Duration{5'000'000}};

TEST(ChangeMonitorOfHealth, ReportsEachChangeOnce) {
  ChangeMonitor monitor;
  EXPECT_EQ(monitor.update(estimate(1, Health::kInitialising)),
            note("1.0 s: initialising at (1.00, -1.00) m"));
  EXPECT_EQ(monitor.update(estimate(2, Health::kInitialising)), std::nullopt);
  EXPECT_EQ(monitor.update(estimate(3, Health::kTracking)),
            note("3.0 s: localised at (3.00, -1.00) m"));
  EXPECT_EQ(monitor.update(estimate(4, Health::kTracking)), std::nullopt);
}

TEST(ChangeMonitorOfHealth, ACoordinateThatRoundsToZeroHasNoMinusSign) {
  ChangeMonitor monitor;
  EstimatedPose at_origin = estimate(1, Health::kInitialising);
  at_origin.map_from_base = {-0.001, -0.002, 0.0};
  EXPECT_EQ(monitor.update(at_origin), note("1.0 s: initialising at (0.00, 0.00) m"));
}

TEST(ChangeMonitorOfHealth, ReportsLostAndRecovered) {
  ChangeMonitor monitor;
  monitor.update(estimate(1, Health::kTracking));
  EXPECT_EQ(monitor.update(estimate(2, Health::kLost)), alarm("2.0 s: lost at (2.00, -1.00) m"));
  EXPECT_EQ(monitor.update(estimate(3, Health::kLost)), std::nullopt);
  EXPECT_EQ(monitor.update(estimate(4.5, Health::kDegenerate)),
            note("4.5 s: re-localised at (4.50, -1.00) m after 2.5 s"));
}

TEST(ChangeMonitorOfHealth, AFlickeringWeakAxisIsNotReported) {
  ChangeMonitor monitor;
  monitor.update(estimate(1, Health::kTracking));
  EXPECT_EQ(monitor.update(estimate(2, Health::kDegenerate)), std::nullopt);
  EXPECT_EQ(monitor.update(estimate(3, Health::kTracking)), std::nullopt);
}

TEST(ChangeMonitorOfHealth, UnknownHealthFromTheStartIsNoChange) {
  ChangeMonitor monitor;
  EXPECT_EQ(monitor.update(estimate(1, Health::kUnknown)), std::nullopt);
}

TEST(ChangeMonitorOfMarkers, ReportsNewAndChangedMarkersOnce) {
  ChangeMonitor monitor;
  const std::vector tentative{landmark(7, 0, LandmarkState::kTentative)};
  const std::vector moved{landmark(7, 0, LandmarkState::kMoved)};
  EXPECT_THAT(monitor.update(kNow, tentative),
              ElementsAre(note("5.0 s: marker 7 at (7.00, 2.00) m is new and tentative")));
  EXPECT_THAT(monitor.update(kNow, tentative), IsEmpty());
  EXPECT_THAT(monitor.update(kNow, moved),
              ElementsAre(alarm("5.0 s: marker 7 at (7.00, 2.00) m is moved")));
  EXPECT_THAT(monitor.update(kNow, moved), IsEmpty());
}

TEST(ChangeMonitorOfMarkers, InstancesOfAnIdAreDifferentMarkers) {
  ChangeMonitor monitor;
  monitor.update(kNow, {landmark(7, 0, LandmarkState::kConfirmed)});
  EXPECT_THAT(monitor.update(kNow, {landmark(7, 1, LandmarkState::kConfirmed),
                                    landmark(7, 0, LandmarkState::kConfirmed)}),
              ElementsAre(note("5.0 s: marker 7.1 at (7.00, 2.00) m is new and confirmed")));
}

TEST(ChangeMonitorOfMarkers, ReportsARemovedMarker) {
  ChangeMonitor monitor;
  monitor.update(kNow, {landmark(0, 0, LandmarkState::kConfirmed)});
  EXPECT_THAT(monitor.update(kNow, {}),
              ElementsAre(note("5.0 s: marker 0, last at (0.00, 2.00) m, is gone")));
  EXPECT_THAT(monitor.update(kNow, {}), IsEmpty());
}

}  // namespace
}  // namespace waymark::viewer

// SPDX-License-Identifier: BSD-3-Clause
// Each condition on messages by itself: at the limit a message is accepted, just beyond it refused.
#include "common/messages/bounds.hpp"
#include "common/messages/codec.hpp"

#include <gtest/gtest.h>

#include <functional>
#include <vector>

namespace waymark {
namespace {

template <class Type>
using Change = std::function<void(Type&)>;

/// Why a message is refused; it is encoded without a check, as by another sender.
template <class Type>
RejectReason reason_of(const Type& message) {
  std::vector<std::uint8_t> payload(static_cast<std::size_t>(message.getEncodedSize()));
  message.encode(payload.data(), 0, message.getEncodedSize());
  return decode<Type>(payload).reason;
}

template <class Type>
void expect_taken(const Type& good, const std::vector<Change<Type>>& changes) {
  EXPECT_EQ(reason_of(good), RejectReason::kNone);
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Type changed = good;
    changes[i](changed);
    EXPECT_EQ(reason_of(changed), RejectReason::kNone) << "change " << i;
  }
}

template <class Type>
void expect_refused(const Type& good, RejectReason reason,
                    const std::vector<Change<Type>>& changes) {
  for (std::size_t i = 0; i < changes.size(); ++i) {
    Type changed = good;
    changes[i](changed);
    EXPECT_EQ(reason_of(changed), reason) << "change " << i;
  }
}

TEST(Validate, BeamsOfAnMbotAreMeasuredNearTheirScan) {
  lidar_t scan{};
  scan.utime = 20'000'000;
  scan.num_ranges = 2;
  scan.ranges = scan.thetas = scan.intensities = {1.0F, 1.0F};
  scan.times = {scan.utime, scan.utime};
  constexpr std::int64_t kFar_us = bounds::kBeamTimeOffset_us;
  expect_taken<lidar_t>(scan, {[](auto& m) { m.times[0] = m.utime - kFar_us; },
                               [](auto& m) {
                                 m.times[1] = m.utime + kFar_us;
                               }});
  expect_refused<lidar_t>(scan, RejectReason::kBadTime,
                          {[](auto& m) { m.times[0] = m.utime - kFar_us - 1; },
                           [](auto& m) {
                             m.times[1] = m.utime + kFar_us + 1;
                           }});
  lidar_t empty{};
  EXPECT_EQ(reason_of(empty), RejectReason::kInconsistent);
  const std::size_t too_many = bounds::kBeams + 1;
  scan.num_ranges = static_cast<std::int32_t>(too_many);
  scan.ranges = scan.thetas = scan.intensities = std::vector<float>(too_many, 1.0F);
  scan.times = std::vector<std::int64_t>(too_many, scan.utime);
  EXPECT_NE(reason_of(scan), RejectReason::kNone);
}

TEST(Validate, AnArrayOfTheWrongSizeIsNotSent) {
  lidar_t scan{};
  scan.num_ranges = 1;
  scan.ranges = scan.thetas = scan.intensities = {1.0F};
  scan.times = {0};
  EXPECT_NO_THROW(encode(channels::kMbotLidar, scan));
  for (const Change<lidar_t>& change : std::vector<Change<lidar_t>>{
           [](auto& m) { m.ranges.push_back(1.0F); }, [](auto& m) { m.thetas.clear(); },
           [](auto& m) { m.times.push_back(0); },
           [](auto& m) {
             m.intensities.clear();
           }}) {
    lidar_t wrong = scan;
    change(wrong);
    EXPECT_THROW(encode(channels::kMbotLidar, wrong), std::logic_error);
  }
}

TEST(Validate, TheCellsOfAGridMatchItsSize) {
  occupancy_grid_t grid{};
  grid.meters_per_cell = 0.1F;
  grid.width = 2;
  grid.height = 3;
  grid.num_cells = 6;
  grid.cells.resize(6);
  expect_taken<occupancy_grid_t>(grid, {});
  expect_refused<occupancy_grid_t>(grid, RejectReason::kInconsistent,
                                   {[](auto& m) { m.width = 3; },
                                    [](auto& m) {
                                      m.width = -2;
                                      m.height = -3;
                                    },
                                    [](auto& m) {
                                      m.meters_per_cell = 0.0F;
                                    }});
}

TEST(Validate, MapChangesHaveAKnownKind) {
  map_changes_t changes{};
  changes.num_changes = 1;
  changes.changes.resize(1, map_change_t{});
  changes.changes[0].kind = map_change_t::KIND_MARKER_MOVED;
  expect_taken<map_changes_t>(changes, {[](auto& m) {
                                m.changes[0].kind = map_change_t::KIND_SURVEY_OFF;
                              }});
  expect_refused<map_changes_t>(
      changes, RejectReason::kInconsistent,
      {[](auto& m) { m.changes[0].kind = map_change_t::KIND_MARKER_MOVED - 1; },
       [](auto& m) {
         m.changes[0].kind = map_change_t::KIND_SURVEY_OFF + 1;
       }});
}

TEST(Validate, GraphEdgesNeedBothVerticesAndAPartNumberInRange) {
  pose_graph_t graph{};
  graph.num_parts = 2;
  graph.num_edges = 1;
  graph.edges.resize(1, graph_edge_t{});
  expect_taken<pose_graph_t>(graph, {[](auto& m) {
                               m.part = 1;
                             }});
  expect_refused<pose_graph_t>(
      graph, RejectReason::kInconsistent,
      {[](auto& m) { m.edges[0].from_vertex = -1; }, [](auto& m) { m.edges[0].to_vertex = -1; },
       [](auto& m) { m.part = -1; },
       [](auto& m) {
         m.part = 2;
       }});
}

}  // namespace
}  // namespace waymark

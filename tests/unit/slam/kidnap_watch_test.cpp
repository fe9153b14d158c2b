// SPDX-License-Identifier: BSD-3-Clause
// Markers that are not where they should be: was the robot carried away, or the marker?
#include "slam/core/landmark/kidnap_watch.hpp"

#include <gtest/gtest.h>

#include <chrono>
#include <numbers>
#include <set>
#include <vector>

namespace waymark {
namespace {

using Verdict = KidnapWatch::Verdict;

constexpr double kGate = 16.3;
constexpr double kNear_m = 0.25;
const Motion kStep{Se2{0.1, 0.0, 0.0}, 0.1, 0.0};

/// Of a marker at a place in the map, seen from where the robot really is.
MarkerMeasurement seen_from(const Se2& map_from_base, int id, const Se2& map_from_marker) {
  MarkerMeasurement measurement;
  measurement.id = id;
  measurement.base_from_marker = map_from_base.inverse() * map_from_marker;
  measurement.covariance = Eigen::Vector3d{1e-4, 1e-4, 1e-4}.asDiagonal();
  return measurement;
}

Se2 place_of(int id) {
  const double side = id % 2 == 0 ? 1.0 : -1.0;
  return {4.0 * (1 + id / 2), side, -side * std::numbers::pi / 2.0};
}

void add_confirmed(Belief& belief, const MarkerMeasurement& measurement) {
  belief.add(measurement);
  while (!belief.markers().back().is_confirmed())
    belief.correct(belief.nearest(measurement)->marker, measurement, kGate);
}

/// Has seen markers 0 to 7, in pairs every 4 m, and believes to stand at x = 15.
Belief travelled() {
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  for (int id = 0; id < 8; ++id)
    add_confirmed(belief, seen_from({}, id, place_of(id)));
  belief.move({Se2{15.0, 0.0, 0.0}, 15.0, 0.0}, {});
  belief.correct_pose(belief.map_from_base(), 1e-4 * Eigen::Matrix3d::Identity());
  return belief;
}

Verdict judge(KidnapWatch& watch, const std::vector<MarkerMeasurement>& seen) {
  return watch.judge(travelled(), seen, kStep, kGate, kNear_m);
}

TEST(KidnapWatch, HasNoDoubtWhereMarkersAreWhereTheyWere) {
  KidnapWatch watch;
  const Se2 truth = travelled().map_from_base();
  EXPECT_EQ(judge(watch, {seen_from(truth, 6, place_of(6))}), Verdict::kSettled);
  EXPECT_EQ(judge(watch, {seen_from(truth, 6, place_of(6)), seen_from(truth, 7, place_of(7))}),
            Verdict::kSettled);
  EXPECT_EQ(judge(watch, {}), Verdict::kSettled);
}

TEST(KidnapWatch, TwoMarkersThatAgreeTellWhereTheRobotIs) {
  KidnapWatch watch;
  const Se2 truth{11.0, 0.1, 0.05};
  const std::vector both{seen_from(truth, 4, place_of(4)), seen_from(truth, 5, place_of(5))};
  EXPECT_EQ(watch.judge(travelled(), both, {}, kGate, kNear_m), Verdict::kDoubtful);
  ASSERT_EQ(watch.judge(travelled(), both, {}, kGate, kNear_m), Verdict::kElsewhere);
  Belief belief = travelled();
  const MarkerMeasurement& by = watch.relocating_marker();
  belief.relocate(*belief.witness(by.id), by);
  EXPECT_NEAR(belief.map_from_base().x(), truth.x(), 1e-9);
  EXPECT_NEAR(belief.map_from_base().y(), truth.y(), 1e-9);
  EXPECT_GT(belief.pose_covariance()(0, 0), 0.1);
  const auto nearest = belief.nearest(by);
  belief.correct(nearest->marker, by, kGate);
  EXPECT_LT(belief.pose_covariance()(0, 0), 0.05);
}

TEST(KidnapWatch, IdsThatAreMisreadOnceCarryNobodyAway) {
  // The markers of a pair, each taken for the other: the robot would look the other way.
  const Se2 truth = travelled().map_from_base();
  KidnapWatch watch;
  EXPECT_EQ(
      watch.judge(travelled(),
                  std::vector{seen_from(truth, 7, place_of(6)), seen_from(truth, 6, place_of(7))},
                  {}, kGate, kNear_m),
      Verdict::kDoubtful);
  EXPECT_EQ(judge(watch, {seen_from(truth, 6, place_of(6)), seen_from(truth, 7, place_of(7))}),
            Verdict::kSettled);
}

TEST(KidnapWatch, OneMarkerAloneIsADoubtUntilTheNext) {
  const Se2 truth{11.0, 0.1, 0.05};
  KidnapWatch watch;
  for (int i = 0; i < 3; ++i) {
    EXPECT_EQ(
        watch.judge(travelled(), std::vector{seen_from(truth, 4, place_of(4))}, {}, kGate, kNear_m),
        Verdict::kDoubtful);
  }
  ASSERT_TRUE(watch.elsewhere());
  EXPECT_NEAR(watch.elsewhere()->x(), 11.0, 1e-9);
  EXPECT_EQ(judge(watch, {}), Verdict::kDoubtful);
  const Se2 later = truth * kStep.start_from_end * kStep.start_from_end;
  const std::vector other{seen_from(later, 5, place_of(5))};
  EXPECT_EQ(watch.judge(travelled(), other, kStep, kGate, kNear_m), Verdict::kDoubtful);
  EXPECT_EQ(watch.judge(travelled(), other, {}, kGate, kNear_m), Verdict::kElsewhere);
}

TEST(KidnapWatch, AWitnessThatTheRobotIsWhereItBelievesEndsTheDoubt) {
  const Se2 truth = travelled().map_from_base();
  const Se2 moved{place_of(4).x() + 4.5, place_of(4).y(), place_of(4).theta()};
  KidnapWatch watch;
  EXPECT_EQ(judge(watch, {seen_from(truth, 4, moved)}), Verdict::kDoubtful);
  EXPECT_EQ(judge(watch, {seen_from(truth, 4, moved), seen_from(truth, 7, place_of(7))}),
            Verdict::kSettled);
  // A marker that was never seen fits what is believed, too.
  EXPECT_EQ(judge(watch, {seen_from(truth, 4, moved), seen_from(truth, 30, {17.0, 1.0, -1.6})}),
            Verdict::kSettled);
}

/// Number of steps after which a doubt passes that `sightings` of one marker have raised.
int doubtful_steps(int sightings) {
  const Se2 truth{11.0, 0.1, 0.05};
  KidnapWatch watch;
  for (int i = 0; i < sightings; ++i)
    watch.judge(travelled(), std::vector{seen_from(truth, 4, place_of(4))}, {}, kGate, kNear_m);
  int steps = 0;
  while (judge(watch, {}) == Verdict::kDoubtful && steps < 1000)
    ++steps;
  return steps;
}

TEST(KidnapWatch, ADoubtWithoutASecondMarkerPasses) {
  EXPECT_LE(doubtful_steps(1), 2);  // a misreading
  EXPECT_GT(doubtful_steps(5), 40);
  EXPECT_LT(doubtful_steps(5), 60);
}

TEST(KidnapWatch, StrangersWhereOthersShouldBeShowThatTheMarkersWereDoubles) {
  KidnapWatch watch;
  Belief belief = travelled();
  // Doubles of the pair at 12 m hang at 20 m; the robot at 17 m takes them for the originals.
  belief.move({Se2{2.0, 0.0, 0.0}, 2.0, 0.0}, {});
  const Se2 mistaken{9.0, 0.0, 0.0};
  const std::vector doubles{seen_from(mistaken, 4, place_of(4)),
                            seen_from(mistaken, 5, place_of(5))};
  EXPECT_EQ(watch.judge(belief, doubles, kStep, kGate, kNear_m), Verdict::kDoubtful);
  ASSERT_EQ(watch.judge(belief, doubles, {}, kGate, kNear_m), Verdict::kElsewhere);
  belief.relocate(*belief.witness(4), doubles[0]);
  EXPECT_NEAR(belief.map_from_base().x(), 9.0, 1e-9);
  // 4 m further on, a new pair hangs where 6 and 7 should be.
  const Motion onwards{Se2{4.0, 0.0, 0.0}, 4.0, 0.0};
  belief.move(onwards, {});
  const Se2 now = belief.map_from_base();
  const std::vector strangers{seen_from(now, 40, place_of(6)), seen_from(now, 41, place_of(7))};
  ASSERT_EQ(watch.judge(belief, strangers, onwards, kGate, kNear_m), Verdict::kBack);
  EXPECT_NEAR(watch.returning_pose().x(), 21.0, 1e-6);
  belief.relocate(watch.returning_pose());
  EXPECT_EQ(watch.judge(belief, strangers, kStep, kGate, kNear_m), Verdict::kSettled);
}

TEST(KidnapWatch, AnIdThatSeveralMarkersHaveIsNoWitness) {
  Belief belief = travelled();
  belief.add(seen_from(belief.map_from_base(), 4, {40.0, 1.0, -1.57}));
  EXPECT_FALSE(belief.witness(4));
  const Se2 truth{11.0, 0.1, 0.05};
  KidnapWatch watch;
  EXPECT_EQ(
      watch.judge(belief, std::vector{seen_from(truth, 4, place_of(4))}, kStep, kGate, kNear_m),
      Verdict::kSettled);
}

TEST(KidnapWatch, AMarkerThatWasSightedOnceOnlyIsNoWitness) {
  Belief belief = travelled();
  const Se2 here = belief.map_from_base();
  belief.add(seen_from(here, 40, {5.0, 1.0, -1.57}));
  belief.add(seen_from(here, 41, {5.0, -1.0, 1.57}));
  KidnapWatch watch;
  const std::vector real{seen_from(here, 40, {17.0, 1.0, -1.57}),
                         seen_from(here, 41, {17.0, -1.0, 1.57})};
  EXPECT_EQ(watch.judge(belief, real, kStep, kGate, kNear_m), Verdict::kSettled)
      << "misread before, they are new now";
}

TEST(Belief, AMarkerThatIsSlightlyOffPullsLessThanOneThatFits) {
  const auto moved_by = [](double off_m) {
    Belief belief = travelled();
    const Se2 before = belief.map_from_base();
    const Se2 seen{place_of(6).x() - off_m, place_of(6).y(), place_of(6).theta()};
    const MarkerMeasurement measurement = seen_from(before, 6, seen);
    belief.correct(belief.nearest(measurement)->marker, measurement, kGate);
    return (belief.map_from_base().x() - before.x()) / off_m;
  };
  const double fits = moved_by(0.01);
  EXPECT_GT(fits, 0.0);
  EXPECT_LT(moved_by(0.3), 0.5 * fits);
  EXPECT_GT(moved_by(0.3), 0.0);
}

/// Marker 4 is gone from x = 2 m, and has turned up at 3 m.
Belief with_moved_marker(bool is_confirmed) {
  using std::chrono::seconds;
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  MarkerMeasurement old = seen_from({}, 4, {2.0, 1.0, -1.57});
  old.time = Timestamp{seconds{1}};
  if (is_confirmed)
    add_confirmed(belief, old);
  else
    belief.add(old);
  MarkerMeasurement fresh = seen_from({}, 4, {3.0, 1.0, -1.57});
  fresh.time = Timestamp{seconds{10}};
  belief.add(fresh);
  const auto all_in_view = [](const Se2&) {
    return true;
  };
  for (int i = 0; i < 4; ++i) {
    belief.note_absences(all_in_view, Timestamp{seconds{9}});
    belief.correct(belief.nearest(fresh)->marker, fresh, kGate);
  }
  EXPECT_EQ(belief.markers().size(), 2U);
  belief.note_absences(all_in_view, Timestamp{seconds{9}});
  EXPECT_EQ(belief.markers().size(), 1U);
  return belief;
}

TEST(Belief, AMarkerThatIsGoneAndHasTurnedUpElsewhereWasMoved) {
  const Landmark marker = with_moved_marker(true).markers().front();
  EXPECT_TRUE(marker.was_moved);
  EXPECT_EQ(marker.instance, 0);
  EXPECT_NEAR(marker.map_from_marker.x(), 3.0, 0.05);
}

TEST(Belief, AMisreadMarkerIsForgottenAndNotCalledMoved) {
  const Landmark marker = with_moved_marker(false).markers().front();
  EXPECT_FALSE(marker.was_moved);
  EXPECT_EQ(marker.instance, 0);
}

TEST(Belief, NamesStayUniqueWhenAMovedMarkerTakesOverItsOldOne) {
  using std::chrono::seconds;
  Belief belief{{OdometryNoise{}, Eigen::Vector3d::Zero()}};
  const auto marker_4_at = [](double x_m, int second) {
    MarkerMeasurement seen = seen_from({}, 4, {x_m, 1.0, -1.57});
    seen.time = Timestamp{seconds{second}};
    return seen;
  };
  add_confirmed(belief, marker_4_at(2.0, 1));
  belief.add(marker_4_at(3.0, 10));
  belief.add(marker_4_at(6.0, 10));
  const auto is_first_place = [](const Se2& base_from_marker) {
    return base_from_marker.x() < 2.5;
  };
  for (int i = 0; i < 5; ++i) {
    const MarkerMeasurement moved = marker_4_at(3.0, 10);
    belief.correct(belief.nearest(moved)->marker, moved, kGate);
    belief.note_absences(is_first_place, Timestamp{seconds{9}});
  }
  ASSERT_EQ(belief.markers().size(), 2U);
  belief.add(marker_4_at(9.0, 11));
  std::set<MarkerName> names;
  for (const Landmark& marker : belief.markers())
    names.insert(name_of(marker));
  EXPECT_EQ(names.size(), 3U);
}

TEST(Belief, AMarkerOutOfViewIsNotMissed) {
  Belief belief = travelled();
  for (int i = 0; i < 20; ++i)
    belief.note_absences([](const Se2&) { return false; }, Timestamp{std::chrono::seconds{9}});
  for (const Landmark& marker : belief.markers())
    EXPECT_EQ(marker.misses, 0);
}

}  // namespace
}  // namespace waymark

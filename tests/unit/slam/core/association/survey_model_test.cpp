// SPDX-License-Identifier: BSD-3-Clause
// What the surveyed landmarks alone say of a survey, against the whole graph.
#include "slam/core/association/survey_model.hpp"

#include "common/random/random.hpp"
#include "slam/core/association/survey.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <variant>
#include <vector>

namespace waymark {
namespace {

constexpr double kPairsApart_m = 2.0;
constexpr double kDriven_m = 0.25;  // from keyframe to keyframe
constexpr std::size_t kSurveyWindow = 20;

bool is_prior_on(const Graph& graph, std::size_t landmark) {
  return std::ranges::any_of(graph.factors(), [&](const Factor& factor) {
    const auto* prior = std::get_if<LandmarkPrior>(&factor);
    return prior && prior->landmark == landmark && !prior->is_off;
  });
}

/// A straight drive past markers on both sides.
class SurveyedDrive {
 public:
  SurveyedDrive(std::size_t num_pairs, std::uint64_t seed)
      : random_{{seed}}, graph_{rolling_only(), Calibration::Constant(1e-6)} {
    for (std::size_t m = 0; m < 2 * num_pairs; ++m)
      add_marker(m);
    graph_.add_keyframe({});
    graph_.add(PosePrior{0, {}, 1e3 * Eigen::Matrix3d::Identity()});
    for (std::size_t k = 1; k < 8 * num_pairs + 4; ++k)
      drive_to(k);
    graph_.optimise_all(20);
    graph_.move_to_frame({});  // the survey will define it
  }

  Graph& graph() { return graph_; }

  const MarkerBook& book() const { return book_; }

  /// With errors of `sigma_m`.
  SurveyedMarker surveyed(std::size_t landmark, double sigma_m) {
    SurveyedMarker marker;
    marker.id = static_cast<int>(landmark);
    marker.survey_from_marker = Se2{markers_[landmark].x() + random_.normal(0.0, sigma_m),
                                    markers_[landmark].y() + random_.normal(0.0, sigma_m), 0.0};
    marker.sigmas = Eigen::Vector3d::Constant(sigma_m);
    return marker;
  }

 private:
  static GraphNoise rolling_only() {
    GraphNoise noise;
    noise.odometry.may_slip = false;
    return noise;
  }

  void add_marker(std::size_t m) {
    const double side = m % 2 == 0 ? 1.0 : -1.0;
    markers_.emplace_back(kPairsApart_m * static_cast<double>(m / 2 + 1), side, -side * M_PI / 2.0);
  }

  void drive_to(std::size_t k) {
    const Se2 truth{kDriven_m * static_cast<double>(k), 0.0, 0.0};
    const Motion motion = Motion::between(
        {}, {kDriven_m + random_.normal(0.0, 1e-3), 0.0, random_.normal(0.0, 1e-3)});
    const Se2 expected = graph_.state().keyframes.back() * motion.start_from_end;
    graph_.add_keyframe(expected);
    graph_.add(OdometryFactor{k - 1, k, motion});
    for (std::size_t m = 0; m < markers_.size(); ++m) {
      const Se2 seen = truth.inverse() * markers_[m];
      if (seen.x() < 0.0 || seen.x() > 2.0) continue;
      sight(m, k,
            Se2{seen.x() + random_.normal(0.0, kSighting_m),
                seen.y() + random_.normal(0.0, kSighting_m), seen.theta()});
    }
    graph_.optimise();
    while (graph_.num_active_keyframes() > kSurveyWindow)
      graph_.marginalise_oldest(1.0);
  }

  void sight(std::size_t id, std::size_t keyframe, const Se2& base_from_marker) {
    MarkerFactor factor;
    factor.keyframe = keyframe;
    factor.measurement.id = static_cast<int>(id);
    factor.measurement.base_from_marker = base_from_marker;
    factor.root_information =
        Eigen::Vector3d{1.0 / kSighting_m, 1.0 / kSighting_m, 100.0}.asDiagonal();
    if (id == book_.entries().size()) {
      book_.add(static_cast<int>(id), {});
      graph_.add_landmark(graph_.state().keyframes.back() * base_from_marker);
    } else {
      book_.note_sighting(id, {});
    }
    factor.landmark = id;
    graph_.add(factor);
  }

  static constexpr double kSighting_m = 0.005;

  Random random_;
  Graph graph_;
  MarkerBook book_{};
  std::vector<Se2> markers_{};
};

LandmarkPrior prior_at(const SurveyedMarker& marker, std::size_t landmark) {
  LandmarkPrior prior;
  prior.landmark = landmark;
  prior.map_from_marker = marker.survey_from_marker;
  prior.root_information =
      Eigen::Vector3d{1.0 / marker.sigmas.x(), 1.0 / marker.sigmas.y(), 0.0}.asDiagonal();
  return prior;
}

struct Surveyed {
  Graph graph;
  std::vector<std::size_t> landmarks{};
  std::vector<LandmarkPrior> priors{};  ///< by their index in `landmarks`

  SurveyModel model() const { return SurveyModel{*graph.marginal_of(landmarks)}; }

  Graph with_priors() const {
    Graph solved = graph;
    for (LandmarkPrior prior : priors) {
      prior.landmark = landmarks[prior.landmark];
      solved.add(prior);
    }
    solved.optimise_all(30);
    return solved;
  }
};

/// Some of the markers, surveyed to a centimetre in a frame that is turned.
Surveyed surveyed_drive(std::uint64_t seed, double turn_rad) {
  SurveyedDrive drive{6, seed};
  Surveyed surveyed{drive.graph(), {0, 3, 6, 11}};
  for (std::size_t i = 0; i < surveyed.landmarks.size(); ++i) {
    SurveyedMarker marker = drive.surveyed(surveyed.landmarks[i], 0.01);
    marker.survey_from_marker = Se2{1.0, -2.0, turn_rad} * marker.survey_from_marker;
    surveyed.priors.push_back(prior_at(marker, i));
  }
  return surveyed;
}

TEST(SurveyModel, TheCostOfThePriorsIsThatInTheWholeGraphInARotatedFrameToo) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    for (const double turn_rad : {0.0, 0.3}) {
      const Surveyed surveyed = surveyed_drive(seed, turn_rad);
      const Graph whole = surveyed.with_priors();
      const SurveyModel model = surveyed.model();
      const SurveyModel::Solution solution = model.solve(surveyed.priors);
      const double contradiction = whole.cost() - surveyed.graph.cost();
      EXPECT_NEAR(solution.cost - model.cost_without_priors(), contradiction,
                  0.1 + 0.02 * contradiction)
          << "seed " << seed << ", " << turn_rad << " rad";
      for (std::size_t i = 0; i < surveyed.landmarks.size(); ++i) {
        const Se2& place = whole.state().landmarks[surveyed.landmarks[i]];
        EXPECT_LT((solution.state.landmarks[i].translation() - place.translation()).norm(), 1e-3);
      }
    }
  }
}

TEST(SurveyModel, ThePredictedSavingIsThatOfSolvingWithoutThePrior) {
  for (std::uint64_t seed = 1; seed <= 10; ++seed) {
    Surveyed surveyed = surveyed_drive(seed, 0.0);
    const SurveyModel model = surveyed.model();
    const SurveyModel::Solution with_all = model.solve(surveyed.priors);
    for (LandmarkPrior& prior : surveyed.priors) {
      const double saving = saving_without(prior, with_all);
      prior.is_off = true;
      const double saved = with_all.cost - model.solve(surveyed.priors).cost;
      prior.is_off = false;
      EXPECT_NEAR(saving, saved, 0.02 + 0.02 * saved);
    }
  }
}

/// Named by a survey of all markers, of which the entry `wrong` is off by half a metre.
std::vector<int> named_of_all(std::uint64_t seed, std::optional<std::size_t> wrong) {
  SurveyedDrive drive{40, seed};
  std::vector<SurveyedMarker> markers;
  for (std::size_t m = 0; m < drive.book().entries().size(); ++m)
    markers.push_back(drive.surveyed(m, 0.005));
  if (wrong)
    markers[*wrong].survey_from_marker = Se2{0.5, 0.0, 0.0} * markers[*wrong].survey_from_marker;
  Survey survey{markers};
  Graph& graph = drive.graph();
  survey.match(graph, drive.book());
  graph.move_to_frame(*survey.new_frame(graph));
  survey.apply(graph);
  graph.optimise_all(12);
  std::vector<int> named;
  for (const MapChange& change : survey.changes(graph))
    named.push_back(change.id);
  return named;
}

TEST(Survey, OfManyCorrectEntriesNoneIsReported) {
  for (std::uint64_t seed = 1; seed <= 3; ++seed)
    EXPECT_TRUE(named_of_all(seed, {}).empty()) << "seed " << seed;
}

TEST(Survey, OfManyEntriesTheWrongOneIsReported) {
  for (const std::size_t wrong : {std::size_t{0}, std::size_t{33}, std::size_t{79}})
    EXPECT_EQ(named_of_all(1, wrong), std::vector{static_cast<int>(wrong)});
}

TEST(Survey, APriorIsTestedAgainWhenItsMarkerHasBeenSightedMuchMoreOften) {
  SurveyedDrive drive{1, 1};
  MarkerBook book;
  book.add(0, {});
  const auto sight = [&book](int times) {
    for (int i = 0; i < times; ++i)
      book.note_sighting(0, {});
  };
  Survey survey{{drive.surveyed(0, 0.005), drive.surveyed(1, 0.005)}};
  EXPECT_FALSE(survey.match(drive.graph(), book));  // once: it may be misread
  sight(2);
  EXPECT_TRUE(survey.match(drive.graph(), book));
  EXPECT_FALSE(survey.match(drive.graph(), book));
  sight(8);
  EXPECT_FALSE(survey.match(drive.graph(), book));
  sight(1);
  EXPECT_TRUE(survey.match(drive.graph(), book));
}

/// Before the frame is known, an entry is associated with another marker of its id, which was
/// sighted first.
TEST(Survey, AnEntryWithoutPriorGoesToTheNearestMarkerOfItsIdOnceTheFrameIsKnown) {
  SurveyedDrive drive{6, 1};
  Graph& graph = drive.graph();
  const std::size_t duplicate = 11;  // of marker 2, at the other end
  MarkerBook book;
  for (std::size_t m = 0; m <= duplicate; ++m) {
    book.add(m == duplicate ? 2 : static_cast<int>(m), {});
    if (m == 2) continue;
    for (int i = 0; i < 2; ++i)
      book.note_sighting(m, {});
  }
  const SurveyedMarker right = drive.surveyed(2, 0.005);
  Survey survey{
      {drive.surveyed(0, 0.005), drive.surveyed(5, 0.005), drive.surveyed(8, 0.005), right}};
  ASSERT_TRUE(survey.match(graph, book));
  graph.move_to_frame(*survey.new_frame(graph));
  survey.apply(graph);
  EXPECT_FALSE(is_prior_on(graph, duplicate));
  EXPECT_EQ(survey.changes(graph).size(), 1U);
  for (int i = 0; i < 2; ++i)
    book.note_sighting(2, {});
  ASSERT_TRUE(survey.match(graph, book));
  survey.apply(graph);
  EXPECT_TRUE(is_prior_on(graph, 2));
  EXPECT_FALSE(is_prior_on(graph, duplicate));
  EXPECT_TRUE(survey.changes(graph).empty());
  const Se2& place = graph.state().landmarks[2];
  EXPECT_LT((place.translation() - right.survey_from_marker.translation()).norm(), 0.1);
}

}  // namespace
}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
// Injected faults: how many messages are affected, which, and that nothing else changes.
#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"
#include "common/messages/convert.hpp"
#include "common/node/node.hpp"
#include "faults/faulty_run.hpp"
#include "faults/injector.hpp"
#include "unit/tools/temporary_folder.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

namespace waymark::faults {
namespace {

using evaluate::TemporaryFolder;
using ::testing::HasSubstr;

constexpr int kFrames = 2000;
constexpr int kMarkersPerFrame = 2;

marker_detection_t sighting(int id, double range_m) {
  marker_detection_t detection{};
  detection.id = id;
  detection.position_m[0] = range_m;
  detection.other_position_m[0] = -range_m;
  detection.orientation[0] = detection.other_orientation[1] = 1.0;
  detection.reprojection_error_px = 0.1;
  detection.other_reprojection_error_px = 0.9;
  return detection;
}

/// A frame every 0.1 s with ids i % 10 and i % 10 + 1, and odometry along x by 1 cm per frame.
std::vector<Message> drive() {
  std::vector<Message> log;
  for (int i = 0; i < kFrames; ++i) {
    const Timestamp time = timestamp_from_us(100'000 * i);
    marker_detections_t frame{};
    frame.utime = to_us(time);
    frame.image_width = 640;
    frame.image_height = 480;
    frame.detections = {sighting(i % 10, 1.0 + i), sighting(i % 10 + 1, 2.0 + i)};
    frame.num_detections = kMarkersPerFrame;
    log.push_back(encode(channels::kMarkers, frame));
    log.push_back(encode(channels::kOdometry, to_pose_message(time, {0.01 * i, 0.0, 0.0})));
  }
  return log;
}

LogContent content_of(const std::vector<Message>& log) {
  LogContent content;
  for (const Message& message : log)
    content.add(message);
  return content;
}

struct Faulty {
  std::vector<Message> log{};
  std::map<std::string, std::int64_t> counts{};

  marker_detections_t frame(int i) const {
    int k = 0;
    for (const Message& message : log) {
      if (message.channel == channels::kMarkers.name && k++ == i)
        return decode<marker_detections_t>(message.payload).message.value();
    }
    throw std::out_of_range{"no such frame"};
  }
};

Faulty with(const FaultConfig& config, std::uint64_t seed = 1) {
  const std::vector<Message> log = drive();
  const LogContent content = content_of(log);
  Injector injector{config, seed, content};
  Faulty faulty;
  for (const Message& message : log) {
    if (const auto result = injector.apply(message)) faulty.log.push_back(*result);
  }
  faulty.counts = injector.counts();
  return faulty;
}

TEST(Faults, WithoutFaultsTheLogIsUnchanged) {
  EXPECT_EQ(with({}).log, drive());
}

TEST(Faults, TheSameSeedGivesTheSameBytesAndAnotherDoesNot) {
  const FaultConfig config{.wrong_id_share = 0.1, .ghost_share = 0.1, .flipped_share = 0.1};
  EXPECT_EQ(with(config, 7).log, with(config, 7).log);
  EXPECT_NE(with(config, 7).log, with(config, 8).log);
}

/// Three standard deviations of a binomial count.
double slack(double share, double count) {
  return 3.0 * std::sqrt(count * share * (1.0 - share));
}

void expect_share(const FaultConfig& config, const std::string& fault, double share, double count) {
  const auto found = static_cast<double>(with(config).counts[fault]);
  EXPECT_NEAR(found, share * count, slack(share, count)) << fault;
}

TEST(Faults, MessagesAreAffectedInTheConfiguredShare) {
  constexpr double kSightings = kFrames * kMarkersPerFrame;
  expect_share({.wrong_id_share = 0.05}, "wrong ids", 0.05, kSightings);
  expect_share({.ghost_share = 0.1}, "ghosts", 0.1, kFrames);
  expect_share({.flipped_share = 0.2}, "sightings flipped", 0.2, kSightings);
  expect_share({.dropped_share = 0.5}, "sightings dropped", 0.5, kSightings);
}

TEST(Faults, AWrongIdIsThatOfAnotherMarkerAndNothingElseChanges) {
  const Faulty faulty = with({.wrong_id_share = 1.0});
  const marker_detections_t frame = faulty.frame(5);
  for (const auto& [detection, id] :
       {std::pair{frame.detections[0], 5}, {frame.detections[1], 6}}) {
    EXPECT_NE(detection.id, id);
    EXPECT_GE(detection.id, 0);
    EXPECT_LE(detection.id, 10);
  }
  EXPECT_EQ(frame.detections[0].position_m[0], 6.0);
}

TEST(Faults, AFlippedMarkerHasTheSecondPoseSolution) {
  const marker_detection_t flipped = with({.flipped_share = 1.0}).frame(3).detections[0];
  EXPECT_EQ(flipped.id, 3);
  EXPECT_EQ(flipped.position_m[0], -4.0);
  EXPECT_EQ(flipped.other_position_m[0], 4.0);
  EXPECT_EQ(flipped.orientation[1], 1.0);
  EXPECT_EQ(flipped.reprojection_error_px, 0.9);
}

TEST(Faults, AFalseDetectionIsAdded) {
  const marker_detections_t frame = with({.ghost_share = 1.0}).frame(3);
  EXPECT_EQ(frame.num_detections, 3);
  EXPECT_EQ(frame.detections[0].id, 3);
}

TEST(Faults, MarkersCanBeGivenTheIdOfOthersAlsoInTheTruth) {
  EXPECT_EQ(with({.every_id = 4}).frame(8).detections[1].id, 4);
  const Faulty renamed = with({.renamed_ids = {8, 2, 9, 3}});
  EXPECT_EQ(renamed.frame(8).detections[0].id, 2);
  EXPECT_EQ(renamed.frame(8).detections[1].id, 3);
  EXPECT_EQ(renamed.frame(1).detections[0].id, 1);
  EXPECT_EQ(
      renamed_markers("id,instance,x_m\n8,0,1.5\n2,0,3.5\n1,0,4.5\n", {.renamed_ids = {8, 2}}, ""),
      "id,instance,x_m\n2,0,1.5\n2,1,3.5\n1,0,4.5\n");
}

TEST(Faults, DarknessGivesFramesWithoutMarkersAndADeadCameraNoFrames) {
  const Faulty dark = with({.markers_off_s = {1.0, 2.0}});
  EXPECT_EQ(dark.log.size(), drive().size());
  EXPECT_EQ(dark.frame(9).num_detections, 2);
  EXPECT_EQ(dark.frame(10).num_detections, 0);
  EXPECT_EQ(dark.frame(20).num_detections, 2);
  Faulty dead = with({.camera_off_s = {1.0, 2.0}});
  EXPECT_EQ(dead.counts["MARKERS lost"], 10);
  EXPECT_EQ(dead.frame(10).utime, 2'000'000);
}

Se2 last_odometry(const Faulty& faulty) {
  return to_se2(decode<pose2D_t>(faulty.log.back().payload).message.value());
}

TEST(Faults, OdometryIsScaledAndDrifts) {
  const double driven_m = 0.01 * (kFrames - 1);
  EXPECT_NEAR(last_odometry(with({.odometry_distance_factor = 1.05})).x(), 1.05 * driven_m, 1e-3);
  EXPECT_NEAR(last_odometry(with({.odometry_drift_rad_per_m = 0.01})).theta(), 0.01 * driven_m,
              1e-3);
}

void write_drive(const std::filesystem::path& log) {
  LogWriter writer{log};
  for (const Message& message : drive())
    writer.write(message);
  writer.close();
}

TEST(FaultyRun, WritesACompleteRunFolder) {
  const TemporaryFolder folder;
  folder.file("run/robot.toml", "[robot]\n");
  folder.file("run/scenario.toml", "[run]\nseed = 3\n");
  folder.file("run/truth_markers.csv", "id,instance,x_m\n3,0,1\n");
  write_drive(folder.path() / "run/run.lcm");
  Variant variant{.name = "equal", .faults = {.every_id = 0}};
  variant.expect.ate_origin_m = 0.15;
  const auto out = folder.path() / "out";
  write_faulty_run(folder.path() / "run", variant, out);
  const auto text = [&](const char* name) {
    std::stringstream stream;
    stream << std::ifstream{out / name}.rdbuf();
    return stream.str();
  };
  EXPECT_EQ(text("truth_markers.csv"), "id,instance,x_m\n0,0,1\n");
  const auto applied = load_config<VariantsFile>({{out / kMark}, {}});
  EXPECT_EQ(applied.named("equal").faults.every_id, 0);
  EXPECT_EQ(text("scenario.toml"), "[run]\nseed = 3\n");
  EXPECT_THAT(text("expect.toml"), HasSubstr("ate_origin_m = 0.15"));
  LogReader reader{out / "run.lcm"};
  const auto first = decode<marker_detections_t>(reader.next()->payload);
  EXPECT_EQ(first.message->detections[1].id, 0);
}

TEST(FaultyRun, TheRecordedRunIsNotOverwritten) {
  const TemporaryFolder folder;
  const Variant variant{.name = "equal", .faults = {.every_id = 0}};
  EXPECT_THROW(write_faulty_run(folder.path() / "none", variant, folder.path() / "out"),
               SetupError);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
  folder.file("run/run.lcm", "the original");
  std::filesystem::create_directory(folder.path() / "out");
  EXPECT_THROW(write_faulty_run(folder.path() / "run", variant, folder.path() / "out/../run/"),
               SetupError);
  EXPECT_EQ(std::filesystem::file_size(folder.path() / "run/run.lcm"), 12U);
}

/// The error of injecting the faults; empty if there is none.
std::string problem_of(const std::filesystem::path& run_dir, const std::filesystem::path& out_dir,
                       const FaultConfig& faults = {.every_id = 0}) {
  try {
    write_faulty_run(run_dir, {.name = "equal", .faults = faults}, out_dir);
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST(FaultyRun, FaultsOfWhichNoneAffectsTheLogAreNamedAndNothingIsWritten) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "run");
  write_drive(folder.path() / "run/run.lcm");
  const auto out = folder.path() / "out";
  const FaultConfig without_effect{.renamed_ids = {999, 5}, .lidar_off_s = {5000.0, 6000.0}};
  EXPECT_THAT(problem_of(folder.path() / "run", out, without_effect),
              HasSubstr("nothing in the log is affected: renamed_ids, lidar_off_s"));
  EXPECT_FALSE(std::filesystem::exists(out));
  EXPECT_EQ(problem_of(folder.path() / "run", out, {}), "") << "no fault is configured";
  EXPECT_EQ(problem_of(folder.path() / "run", folder.path() / "some",
                       {.wrong_id_share = 0.5, .renamed_ids = {999, 5}}),
            "");
}

TEST(FaultyRun, ABadLineOfTheTruthIsNamedBeforeAnythingIsWritten) {
  const TemporaryFolder folder;
  const auto truth = folder.file("run/truth_markers.csv", "id,instance,x_m\n3,0,1\nx,0,2\n");
  write_drive(folder.path() / "run/run.lcm");
  EXPECT_THAT(problem_of(folder.path() / "run", folder.path() / "out"),
              HasSubstr(truth.string() + ":3: got 'x,0,2'"));
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "out"));
}

TEST(FaultyRun, ReplaysOfOtherFaultsAreNotKeptBesideANewLog) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "run");
  write_drive(folder.path() / "run/run.lcm");
  const auto out = folder.path() / "out";
  const FaultConfig others{.dropped_share = 0.5};
  EXPECT_EQ(problem_of(folder.path() / "run", out), "");
  EXPECT_EQ(problem_of(folder.path() / "run", out, others), "") << "not replayed yet";
  folder.file("out/waymark/config.toml", "");
  EXPECT_EQ(problem_of(folder.path() / "run", out, others), "") << "the same faults: made again";
  EXPECT_THAT(problem_of(folder.path() / "run", out),
              HasSubstr("waymark: is a replay of another drive or other faults"));
  folder.file("run/truth.tum", "0 0 0 0 0 0 0 1\n");
  EXPECT_THAT(problem_of(folder.path() / "run", out, others), HasSubstr("another drive"));
}

TEST(FaultyRun, FaultsAreNotInjectedTwice) {
  const TemporaryFolder folder;
  std::filesystem::create_directory(folder.path() / "run");
  write_drive(folder.path() / "run/run.lcm");
  const auto faulty = folder.path() / "faulty";
  EXPECT_EQ(problem_of(folder.path() / "run", faulty), "");
  EXPECT_EQ(problem_of(folder.path() / "run", faulty), "") << "made anew";
  EXPECT_EQ(problem_of(faulty, folder.path() / "twice"),
            (faulty / "variant_applied.toml").string() +
                ": says that this run has faults already; give the folder of the recorded run");
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "twice"));
}

TEST(FaultyRun, AnotherRunsFolderIsNotOverwritten) {
  const TemporaryFolder folder;
  folder.file("run/run.lcm", "");
  const auto other = folder.file("other/run.lcm", "another recording");
  EXPECT_THAT(problem_of(folder.path() / "run", folder.path() / "other"),
              HasSubstr("run.lcm: is there already, and not of a faulty run"));
  EXPECT_EQ(std::filesystem::file_size(other), 17U);
  EXPECT_FALSE(std::filesystem::exists(folder.path() / "other" / kMark));
}

TEST(Variants, InvalidVariantsAreNamed) {
  const TemporaryFolder folder;
  const auto problem_of = [&](const std::string& text) -> std::string {
    try {
      load_config<VariantsFile>({{folder.file("v.toml", text)}, {}});
    } catch (const ConfigError& error) {
      return error.what();
    }
    return "";
  };
  EXPECT_EQ(problem_of("[[variant]]\nname = 'a'\n[variant.faults]\nghost_share = 0.1\n"), "");
  EXPECT_THAT(problem_of("[[variant]]\nname = 'a b'\n"), HasSubstr("expected letters"));
  EXPECT_THAT(problem_of("[[variant]]\nname = 'a'\n[[variant]]\nname = 'a'\n"), HasSubstr("twice"));
  EXPECT_THAT(problem_of("[[variant]]\nname = 'a'\n[variant.faults]\nlidar_off_s = [3.0, 2.0]\n"),
              HasSubstr("a.faults.lidar_off_s: expected pairs with the earlier"));
  EXPECT_THAT(problem_of("[[variant]]\nname = 'a'\n[variant.faults]\nghost_shares = 0.1\n"),
              HasSubstr("did you mean"));
}

TEST(Variants, TheFileInDeployIsValid) {
  const auto file =
      load_config<VariantsFile>({{WAYMARK_SOURCE_DIR "/deploy/faults/messages.toml"}, {}});
  EXPECT_EQ(file.named("wrong_ids").faults.wrong_id_share, 0.05);
  EXPECT_THROW(file.named("none"), ConfigError);
}

}  // namespace
}  // namespace waymark::faults

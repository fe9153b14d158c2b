// SPDX-License-Identifier: BSD-3-Clause
// Random damage to good logs: the importers return an error or a log, whose records are always in
// order and valid; they never crash.
#include "common/errors/setup_error.hpp"
#include "common/messages/convert.hpp"
#include "foreign_payloads.hpp"
#include "import/carmen/carmen_reader.hpp"
#include "import/findings/findings.hpp"
#include "import/log/log_output.hpp"
#include "import/mbot/mbot_reader.hpp"
#include "import_files.hpp"

#include <bzlib.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <zlib.h>

#include <algorithm>
#include <random>

namespace waymark {
namespace {

constexpr int kTrials = 800;
constexpr int kTrialsPerWrite = 20;  // writing takes longer than importing

/// Flips, overwrites, removes, repeats or cuts bytes in one to four places.
std::string mutated(std::string bytes, std::mt19937& random) {
  for (unsigned edits = 1 + random() % 4; edits > 0 && !bytes.empty(); --edits) {
    const std::size_t at = random() % bytes.size();
    const std::size_t length = std::min<std::size_t>(1 + random() % 40, bytes.size() - at);
    switch (random() % 6) {
      case 0:
        bytes[at] = static_cast<char>(random());
        break;
      case 1:
        bytes[at] = static_cast<char>(bytes[at] ^ (1 << random() % 8));
        break;
      case 2:
        bytes.erase(at, length);
        break;
      case 3:
        bytes.insert(at, bytes.substr(at, length));
        break;
      case 4:
        bytes[at] = "0123456789-.enaif \n"[random() % 19];
        break;
      default:
        bytes.resize(random() % 8 == 0 ? at : bytes.size());
    }
  }
  return bytes;
}

template <class Records>
bool ascends(const Records& records) {
  return std::ranges::adjacent_find(records, [](const auto& a, const auto& b) {
           return a.time >= b.time;
         }) == records.end();
}

/// Imports, examines and, now and then, writes; false when the log was refused with a sentence.
template <class Read>
bool import_survives(int trial, ImportReport& report, const Read& read) {
  try {
    ImportedLog log = read();
    examine(log, ReversedOdometry::kCorrect, report);
    EXPECT_TRUE(ascends(log.scans));
    EXPECT_TRUE(ascends(log.odometry));
    EXPECT_LE(log.odometry.front().time, log.scans.front().time);
    EXPECT_GE(log.odometry.back().time, log.scans.back().last_beam_time);
    if (trial % kTrialsPerWrite == 0) {
      std::filesystem::remove(test_folder() / "robot.toml");
      std::filesystem::remove(test_folder() / "reference.tum");
      std::filesystem::remove(test_folder() / "out.lcm");
      write_imported_log(log, report, test_folder() / "out.lcm");
    }
    return true;
  } catch (const SetupError& error) {
    EXPECT_STRNE(error.what(), "");
    EXPECT_THAT(std::string{error.what()}, ::testing::Not(::testing::HasSubstr("\n")));
    return false;
  }
}

TEST(Mutations, MutationsOfACarmenLogNeverCrashTheImporter) {
  const std::string good = read_file(data_file("small.clf")) +
                           "ROBOTLASER1 0 -1 2 0.5 20 0.01 1 4 1 2 3 50 1 7 1 0.25 1.5707963 1 0 "
                           "1.5707963 0 0 0 0 0 13 host 3\n";
  std::mt19937 random{1};
  int imported = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto file = write_file("mutated.clf", mutated(good, random));
    CarmenOptions options{};
    options.beams = {-1.0, 0.5};
    if (trial % 2 == 0) options.odometry = CarmenOdometrySource::kOdomLines;
    ImportReport report{file, AddressUnit::kLine};
    imported +=
        import_survives(trial, report, [&] { return read_carmen_log(file, options, report); });
  }
  EXPECT_GT(imported, kTrials / 2);
}

std::string with_gzip(const std::string& text) {
  const auto file = write_file("whole.gz", "");
  gzFile gz = gzopen(file.c_str(), "wb");
  gzwrite(gz, text.data(), static_cast<unsigned>(text.size()));
  gzclose(gz);
  return read_file(file);
}

std::string with_bzip2(std::string text) {
  const auto file = write_file("whole.bz2", "");
  BZFILE* bz = BZ2_bzopen(file.c_str(), "wb");
  BZ2_bzwrite(bz, text.data(), static_cast<int>(text.size()));
  BZ2_bzclose(bz);
  return read_file(file);
}

TEST(Mutations, OfCompressedLogsAndEveryCutOfThemNeverCrash) {
  const std::string text = read_file(data_file("small.clf"));
  CarmenOptions options{};
  options.beams = {-1.0, 0.5};
  std::mt19937 random{3};
  for (const std::string& good : {with_gzip(text), with_bzip2(text)}) {
    for (std::size_t length = 0; length <= good.size(); ++length) {
      const bool is_whole = length == good.size();
      const auto file = write_file("cut", good.substr(0, length));
      ImportReport report{file, AddressUnit::kLine};
      const bool imported =
          import_survives(1, report, [&] { return read_carmen_log(file, options, report); });
      EXPECT_TRUE(is_whole ? imported : !imported || report.num_skipped() > 0)
          << length << " of " << good.size() << " bytes were taken for the whole log";
    }
    for (int trial = 0; trial < kTrials / 4; ++trial) {
      const auto file = write_file("mutated", mutated(good, random));
      ImportReport report{file, AddressUnit::kLine};
      import_survives(trial, report, [&] { return read_carmen_log(file, options, report); });
    }
  }
}

std::string good_lcm_log() {
  std::vector<Message> events;
  for (int i = 0; i < 6; ++i) {
    const Timestamp time = timestamp_from_us(1'000'000 + 100'000 * i);
    const LidarScan scan{time, {1.0, 2.0, 3.0}, {0.0, -0.5, -1.0}, {}};
    events.push_back({"TICKS", time, maebot_encoders(to_us(time), 10 * i, 12 * i)});
    events.push_back({"ODO", time, bot_core_pose(to_us(time), 0.01 * i, 0.0, 1.0, 0.0)});
    events.push_back({"RPLIDAR_LASER", time,
                      i < 4 ? encode(channels::kMbotLidar, to_mbot_lidar(scan)).payload
                            : encode(channels::kLidar, to_planar_lidar(scan)).payload});
    events.push_back({"POSE", time,
                      encode(channels::kSlamPose, to_pose_message(time, {0.1 * i, 0, 0})).payload});
  }
  return read_file(write_log("good.lcm", events));
}

TEST(Mutations, OfAnLcmLogNeverCrash) {
  const std::string good = good_lcm_log();
  std::mt19937 random{2};
  int imported = 0;
  for (int trial = 0; trial < kTrials; ++trial) {
    const auto file = write_file("mutated.lcm", mutated(good, random));
    MbotOptions options{};
    (trial % 2 == 0 ? options.encoder_channel : options.odometry_channel) =
        trial % 2 == 0 ? "TICKS" : "ODO";
    options.reference_channel = "POSE";
    ImportReport report{file, AddressUnit::kByte};
    imported +=
        import_survives(trial, report, [&] { return read_mbot_log(file, options, report); });
  }
  EXPECT_GT(imported, kTrials / 2);
}

}  // namespace
}  // namespace waymark

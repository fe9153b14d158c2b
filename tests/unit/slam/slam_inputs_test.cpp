// SPDX-License-Identifier: BSD-3-Clause
// Which files slam refuses before it starts.
#include "common/log/log_file.hpp"
#include "slam/slam_node.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace waymark {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;

class SlamInputs : public ::testing::Test {
 protected:
  SlamInputs() { fs::create_directories(folder_); }

  ~SlamInputs() override { fs::remove_all(folder_); }

  static void write_log(const fs::path& file, const std::string& channel) {
    LogWriter log{file};
    log.write({channel, timestamp_from_us(1), {1, 2, 3}});
    log.close();
  }

  std::string why_refused(const SlamConfig& config) const {
    try {
      SlamNode::check(config);
      return "";
    } catch (const SetupError& error) {
      return error.what();
    }
  }

  std::string why_not_saved_to(const fs::path& file) const {
    SlamConfig config;
    config.save_map = file;
    return why_refused(config);
  }

  const fs::path folder_ =
      fs::path{::testing::TempDir()} / (std::string{"slam_inputs_"} + std::to_string(::getpid()));
};

TEST_F(SlamInputs, AFileThatIsNotAMapIsNotReplacedByTheMap) {
  const fs::path recording = folder_ / "run.lcm";
  write_log(recording, "ODOMETRY");
  EXPECT_THAT(why_not_saved_to(recording), HasSubstr(recording.string() + "' is there already"));
  const fs::path notes = folder_ / "notes.txt";
  std::ofstream{notes} << "precious";
  EXPECT_THAT(why_not_saved_to(notes), HasSubstr("is not a map"));
}

TEST_F(SlamInputs, ARecordingThatGoesOnIsNotOverwritten) {
  const fs::path recording = folder_ / "run.lcm";
  LogWriter log{recording};
  log.write({"CAMERA", timestamp_from_us(1), std::vector<std::uint8_t>(2U << 20U)});
  EXPECT_THAT(why_not_saved_to(recording), HasSubstr("run.lcm.part' is there already"));
}

TEST_F(SlamInputs, AMapAnEmptyFileAndANewNameMayBeWritten) {
  const fs::path map = folder_ / "old.map.lcm";
  write_log(map, "MAP_HEADER");  // cut off behind it: a damaged map is a map
  EXPECT_EQ(why_not_saved_to(map), "");
  std::ofstream{folder_ / "empty"};
  EXPECT_EQ(why_not_saved_to(folder_ / "empty"), "");
  EXPECT_EQ(why_not_saved_to(folder_ / "new.map.lcm"), "");
}

TEST_F(SlamInputs, AStateFolderThatIsAFileIsRefusedAndAMissingOneIsNotMade) {
  std::ofstream{folder_ / "file"} << "precious";
  SlamConfig config;
  config.slam.state_folder = folder_ / "file";
  EXPECT_THAT(why_refused(config), HasSubstr("file: files cannot be written there"));
  config.slam.state_folder = folder_ / "state";
  EXPECT_EQ(why_refused(config), "");
  EXPECT_FALSE(fs::exists(folder_ / "state"));
}

}  // namespace
}  // namespace waymark

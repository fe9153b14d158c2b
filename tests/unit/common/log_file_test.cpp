// SPDX-License-Identifier: BSD-3-Clause
#include "common/log/log_file.hpp"

#include "common/errors/setup_error.hpp"

#include <fcntl.h>
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/syscall.h>
#include <unistd.h>

#include <ctime>
#include <fstream>
#include <sstream>

namespace {

std::vector<std::string> disk_calls;  ///< system calls, in order

std::string name_of(int descriptor) {
  return std::filesystem::read_symlink("/proc/self/fd/" + std::to_string(descriptor))
      .filename()
      .string();
}

}  // namespace

// Replace the functions of the C library, and call them.
extern "C" int fsync(int descriptor) {
  disk_calls.push_back("flush " + name_of(descriptor));
  return static_cast<int>(::syscall(SYS_fsync, descriptor));
}

extern "C" int rename(const char* from, const char* to) noexcept {
  disk_calls.push_back("rename to " + std::filesystem::path{to}.filename().string());
  return static_cast<int>(::syscall(SYS_renameat2, AT_FDCWD, from, AT_FDCWD, to, 0));
}

namespace waymark {
namespace {

class LogFile : public ::testing::Test {
 protected:
  void SetUp() override { std::filesystem::remove(path_); }

  std::filesystem::path path_{std::filesystem::path{::testing::TempDir()} /
                              ::testing::UnitTest::GetInstance()->current_test_info()->name()};

  static Message event(int i) {
    return {i % 2 == 0 ? "EVEN" : "ODD", timestamp_from_us(1000 * i),
            std::vector<std::uint8_t>(static_cast<std::size_t>(i), static_cast<std::uint8_t>(i))};
  }

  std::string good_log(int num_events) const {
    LogWriter writer{path_};
    for (int i = 0; i < num_events; ++i)
      writer.write(event(i));
    writer.close();
    std::ifstream file{path_, std::ios::binary};
    std::stringstream bytes;
    bytes << file.rdbuf();
    return bytes.str();
  }

  static std::string name_of_folder(const std::filesystem::path& path) {
    return std::filesystem::canonical(path.parent_path()).filename().string();
  }

  void put(const std::string& bytes) const { std::ofstream{path_, std::ios::binary} << bytes; }

  std::vector<Message> read(std::int64_t& skipped_bytes) const {
    LogReader reader{path_};
    std::vector<Message> events;
    while (auto message = reader.next())
      events.push_back(*message);
    skipped_bytes = reader.skipped_bytes();
    return events;
  }
};

TEST_F(LogFile, IsSyncedBeforeItIsRenamed) {
  disk_calls.clear();
  LogWriter writer{path_};
  writer.write(event(3));
  writer.close_on_disk();
  const std::string name = path_.filename().string();
  EXPECT_THAT(disk_calls, ::testing::ElementsAre("flush " + name + ".part", "rename to " + name,
                                                 "flush " + name_of_folder(path_)));
}

TEST_F(LogFile, WhatIsWrittenIsRead) {
  good_log(10);
  std::int64_t skipped_bytes = -1;
  const auto events = read(skipped_bytes);
  ASSERT_EQ(events.size(), 10U);
  for (int i = 0; i < 10; ++i)
    EXPECT_EQ(events[static_cast<std::size_t>(i)], event(i));
  EXPECT_EQ(skipped_bytes, 0);
}

TEST_F(LogFile, HasTheFormatOfLcm) {
  // Event 1 of the log: sync word, number 1, time 1000, channel of 3 bytes, data of 1 byte.
  const std::string bytes = good_log(2).substr(28 + 4);
  const std::string expected{
      "\xED\xA1\xDA\x01\0\0\0\0\0\0\0\x01\0\0\0\0\0\0\x03\xE8\0\0\0\x03\0\0\0\x01ODD\x01", 32};
  EXPECT_EQ(bytes, expected);
}

TEST_F(LogFile, OnlyAClosedLogGetsItsFinalName) {
  {
    LogWriter writer{path_};
    writer.write(event(1));
    EXPECT_FALSE(std::filesystem::exists(path_));
    writer.close();
  }
  EXPECT_TRUE(std::filesystem::exists(path_));
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".part"));
}

TEST_F(LogFile, AWriterThatIsNotClosedLeavesWhatItHasWritten) {
  const std::filesystem::path part = part_path_of(path_);
  { const LogWriter unused{path_}; }
  EXPECT_FALSE(std::filesystem::exists(part));
  { LogWriter{path_}.write(event(1)); }
  EXPECT_TRUE(std::filesystem::exists(part));
  std::filesystem::remove(part);
}

TEST_F(LogFile, UnwantedChannelsAreSkippedAndListed) {
  good_log(6);
  LogReader reader{path_};
  int count = 0;
  while (auto message = reader.next([](std::string_view channel) { return channel == "ODD"; })) {
    EXPECT_EQ(message->channel, "ODD");
    ++count;
  }
  EXPECT_EQ(count, 3);
  EXPECT_EQ(channels_in(path_), (std::vector<std::string>{"EVEN", "ODD"}));
}

TEST_F(LogFile, GarbageBeforeBetweenAndBehindEventsIsCountedAndNothingElseIsLost) {
  const std::string good = good_log(10);
  const std::string sync{"\xED\xA1\xDA\x01", 4};
  const auto middle = good.find(sync, good.size() / 2);
  const std::string garbage = "garbage " + sync + " more";
  put(garbage + good.substr(0, middle) + garbage + good.substr(middle) + std::string(50, '\0'));

  std::int64_t skipped_bytes = 0;
  const auto events = read(skipped_bytes);

  EXPECT_EQ(events.size(), 10U);
  EXPECT_EQ(skipped_bytes, static_cast<std::int64_t>(2 * garbage.size() + 50));
}

// A search that begins with a megabyte would read 100 GB here.
TEST_F(LogFile, GarbageBehindEveryEventCostsNoMoreThanItsBytes) {
  constexpr int kEvents = 200'000;
  const std::string one = good_log(1) + "?";
  std::string bytes;
  for (int i = 0; i < kEvents; ++i)
    bytes += one;
  put(bytes);
  const std::clock_t begin = std::clock();  // CPU time, as the machine may be busy
  std::int64_t skipped_bytes = 0;
  EXPECT_EQ(read(skipped_bytes).size(), std::size_t{kEvents});
  EXPECT_EQ(skipped_bytes, kEvents);
  EXPECT_LT(std::clock() - begin, 5 * CLOCKS_PER_SEC);
}

TEST_F(LogFile, ACutOffEventIsCounted) {
  const std::string good = good_log(10);
  put(good.substr(0, good.size() - 3));
  std::int64_t skipped_bytes = 0;
  EXPECT_EQ(read(skipped_bytes).size(), 9U);
  EXPECT_EQ(skipped_bytes, 28 + 3 + 9 - 3);
}

// Lengths that crash liblcm's own reader (research/lcm.md A9).
TEST_F(LogFile, HostileLengthsSkipOneEventOnly) {
  for (const std::string& length :
       {std::string{"\x7f\xff\xff\xff"}, std::string{"\xff\xff\xff\xff"},
        std::string{"\x7f\xff\xff\xf0"}}) {
    std::string bytes = good_log(10);
    const std::size_t event_1 = 28 + 4;
    bytes.replace(event_1 + 24, 4, length);
    put(bytes);
    std::int64_t skipped_bytes = 0;
    EXPECT_EQ(read(skipped_bytes).size(), 9U);
    EXPECT_EQ(skipped_bytes, 28 + 3 + 1);
  }
}

/// The error message of opening a file.
template <class Log>
std::string problem_of(const std::filesystem::path& path) {
  try {
    const Log log{path};
  } catch (const std::runtime_error& error) {
    return error.what();
  }
  return "";
}

TEST_F(LogFile, WhatCannotBeOpenedIsNamedWithTheReason) {
  EXPECT_EQ(problem_of<LogReader>("/no/such.lcm"),
            "/no/such.lcm: cannot be read: No such file or directory");
  EXPECT_EQ(problem_of<LogReader>("/tmp"), "/tmp: is a folder or a device, not an LCM log");
  EXPECT_EQ(problem_of<LogReader>("/dev/null"),
            "/dev/null: is a folder or a device, not an LCM log");
  EXPECT_EQ(problem_of<LogWriter>("/no/such/folder.lcm"),
            "/no/such/folder.lcm.part: cannot be created: No such file or directory");
  const std::string long_name = "/tmp/" + std::string(300, 'a');
  EXPECT_EQ(problem_of<LogWriter>(long_name),
            long_name + ".part: cannot be created: File name too long");
}

TEST_F(LogFile, OnlyARegularFileIsReplaced) {
  std::filesystem::create_directory(path_);
  EXPECT_THROW(LogWriter{path_}, std::runtime_error);
  std::filesystem::remove(path_);
  std::filesystem::create_symlink("/dev/null", path_);
  EXPECT_THROW(LogWriter{path_}, std::runtime_error);
  EXPECT_FALSE(std::filesystem::exists(path_.string() + ".part"));
}

TEST_F(LogFile, WouldOverwriteRecognisesLinksAndOtherSpellingsOfAPath) {
  good_log(1);
  const auto other_spelling = path_.parent_path() / "." / path_.filename();
  const std::filesystem::path link = path_.string() + ".link";
  const std::filesystem::path part = path_.string() + ".part";
  std::filesystem::remove(link);
  std::filesystem::create_symlink(path_, link);
  EXPECT_TRUE(would_overwrite(path_, path_));
  EXPECT_TRUE(would_overwrite(other_spelling, path_));
  EXPECT_TRUE(would_overwrite(path_, link));
  EXPECT_FALSE(would_overwrite(path_.string() + ".copy", path_));
  std::ofstream{part} << "what is left of a recording";
  EXPECT_TRUE(would_overwrite(path_, part));
  std::filesystem::remove(part);
  std::filesystem::remove(link);
}

TEST_F(LogFile, WritingOverAnInputIsRefusedAndBothPathsAreNamed) {
  good_log(1);
  const std::filesystem::path elsewhere = path_.string() + ".other";
  EXPECT_NO_THROW(protect_inputs("--out-log", elsewhere, {path_}));
  try {
    protect_inputs("--out-log", path_, {elsewhere, path_});
    FAIL() << "it would be overwritten";
  } catch (const SetupError& error) {
    EXPECT_EQ(error.what(), "--out-log: " + path_.string() + " would overwrite " + path_.string() +
                                ", which is to be read: give another name");
  }
}

TEST_F(LogFile, AFullDiskIsReported) {
  std::filesystem::create_symlink("/dev/full", path_.string() + ".part");
  LogWriter writer{path_};
  EXPECT_THROW(
      {
        for (int i = 0; i < 3000; ++i)
          writer.write(event(1000));
        writer.close();
      },
      std::runtime_error);
  std::filesystem::remove(path_.string() + ".part");
}

}  // namespace
}  // namespace waymark

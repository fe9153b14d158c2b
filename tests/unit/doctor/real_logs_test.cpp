// SPDX-License-Identifier: BSD-3-Clause
// Real logs, which are third-party data outside the project: the doctor finds the faults that their
// README states. Skipped where they are absent.
#include "doctor/doctor.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>

namespace waymark {
namespace {

std::optional<std::filesystem::path> real_log(const std::string& name) {
  const char* data = std::getenv("WAYMARK_DATA");
  for (const std::filesystem::path& folder :
       {std::filesystem::path{data != nullptr ? data : ""},
        std::filesystem::path{WAYMARK_SOURCE_DIR} / "../shared/data",
        std::filesystem::path{"/work/shared/data"}}) {
    const auto file = folder / "logs" / name;
    if (std::filesystem::exists(file)) return file;
  }
  return std::nullopt;
}

struct Seen {
  Diagnosis diagnosis;

  const Check& at(const std::string& name) const {
    return *std::ranges::find(diagnosis.checks, name, &Check::name);
  }
};

Seen see(const std::filesystem::path& file) {
  return {diagnose(read_input(file, {}, {}))};
}

TEST(DoctorOnRealLogs, PublishedFr079CountsBackingUpAsForward) {
  const auto file = real_log("fr079_original.clf.bz2");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079_original.clf.bz2 is not on this machine";
  const Seen seen = see(*file);
  EXPECT_EQ(seen.at("backing_up").verdict, Verdict::kFail);
  EXPECT_NEAR(seen.at("backing_up").value.value(), 10.1, 0.5);
  EXPECT_NEAR(seen.at("no_return").value.value(), 81.91, 1e-3);
  EXPECT_EQ(seen.at("lidar_mirrored").verdict, Verdict::kPass);
  EXPECT_EQ(seen.at("lidar_yaw").verdict, Verdict::kPass);
}

TEST(DoctorOnRealLogs, RebuiltFr079PassesTheCheckOfBackingUp) {
  const auto file = real_log("fr079.clf.gz");
  if (!file) GTEST_SKIP() << "shared/data/logs/fr079.clf.gz is not on this machine";
  const Seen seen = see(*file);
  EXPECT_EQ(seen.at("backing_up").verdict, Verdict::kPass) << "signs were repaired";
  EXPECT_EQ(seen.at("lidar_mirrored").verdict, Verdict::kPass);
  EXPECT_NE(seen.at("odometry_distance_scale").verdict, Verdict::kFail);
}

TEST(DoctorOnRealLogs, AcesWrites50MetresForNoReturn) {
  const auto file = real_log("aces.clf.bz2");
  if (!file) GTEST_SKIP() << "shared/data/logs/aces.clf.bz2 is not on this machine";
  const Seen seen = see(*file);
  EXPECT_EQ(seen.at("no_return").value.value(), 50.0);
  EXPECT_EQ(seen.at("no_return").verdict, Verdict::kWarn) << "there is no description";
  EXPECT_EQ(seen.at("backing_up").verdict, Verdict::kPass);
  EXPECT_EQ(seen.at("lidar_mirrored").verdict, Verdict::kPass);
  EXPECT_EQ(seen.at("time_offset").verdict, Verdict::kPass);
}

TEST(DoctorOnRealLogs, MbotConvexPassesTheLidarAndTrafficChecks) {
  const auto file = real_log("mbot_convex.lcm");
  if (!file) GTEST_SKIP() << "shared/data/logs/mbot_convex.lcm is not on this machine";
  const Seen seen = see(*file);
  EXPECT_EQ(seen.at("no_return").verdict, Verdict::kPass) << "0 is lidar_t's own";
  EXPECT_EQ(seen.at("lidar_mirrored").verdict, Verdict::kPass) << "clockwise thetas are its type's";
  EXPECT_EQ(seen.at("traffic").verdict, Verdict::kPass);
}

}  // namespace
}  // namespace waymark

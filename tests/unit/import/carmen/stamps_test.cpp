// SPDX-License-Identifier: BSD-3-Clause
#include "import/carmen/stamps.hpp"

#include "common/errors/setup_error.hpp"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <functional>

namespace waymark {
namespace {

using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

using Clock = std::function<int(int scan)>;  // [ms]

std::vector<CarmenTimes> times(const Clock& ipc, const Clock& logger) {
  std::vector<CarmenTimes> all;
  for (int i = 0; i < 50; ++i)
    all.push_back({timestamp_from_us(1000 * ipc(i)), timestamp_from_us(1000 * logger(i))});
  return all;
}

int stands(int /*scan*/) {
  return 7;
}

int advances(int scan) {
  return 1000 + 200 * scan;
}

int jumps(int scan) {
  return 1000 + 200 * scan + (scan % 2 == 0 ? 5000 : 0);
}

TEST(Stamps, IpcTimesAreUsedIfTheyAdvance) {
  ImportReport report{"log", AddressUnit::kLine};
  EXPECT_EQ(choose_stamps(times(advances, advances), {}, report), CarmenStamps::kIpc);
  EXPECT_EQ(choose_stamps(times(advances, stands), {}, report), CarmenStamps::kIpc);
  const Clock slightly_disordered = [](int scan) {
    return 1000 + 50 * (scan ^ 1);
  };
  EXPECT_EQ(choose_stamps(times(slightly_disordered, advances), {}, report), CarmenStamps::kIpc);
  const Clock one_bad = [](int scan) {
    return scan == 20 ? 0 : advances(scan);
  };
  EXPECT_EQ(choose_stamps(times(one_bad, advances), {}, report), CarmenStamps::kIpc);
  EXPECT_THAT(report.notes(), IsEmpty());
}

TEST(Stamps, LoggerTimesAreUsedIfIpcTimesStandStillOrJump) {
  for (const Clock& ipc : {Clock{stands}, Clock{jumps}}) {
    ImportReport report{"log", AddressUnit::kLine};
    EXPECT_EQ(choose_stamps(times(ipc, advances), {}, report), CarmenStamps::kLogger);
    EXPECT_THAT(report.notes(), ElementsAre(HasSubstr("logger_timestamp in 50: the latter")));
  }
}

TEST(Stamps, TheUsersChoiceIsKept) {
  ImportReport report{"log", AddressUnit::kLine};
  EXPECT_EQ(choose_stamps(times(jumps, advances), CarmenStamps::kIpc, report), CarmenStamps::kIpc);
  EXPECT_EQ(choose_stamps(times(advances, jumps), CarmenStamps::kLogger, report),
            CarmenStamps::kLogger);
  EXPECT_THAT(report.notes(), IsEmpty());
}

TEST(Stamps, ALogWithoutTimesIsRefused) {
  ImportReport report{"log", AddressUnit::kLine};
  EXPECT_THROW(choose_stamps(times(stands, stands), {}, report), SetupError);
}

}  // namespace
}  // namespace waymark

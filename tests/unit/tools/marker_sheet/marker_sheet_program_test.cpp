// SPDX-License-Identifier: BSD-3-Clause
// Exit codes of the program itself.
#include "unit/tools/temporary_folder.hpp"

#include <gtest/gtest.h>
#include <sys/wait.h>

#include <cstdlib>

namespace waymark::marker_sheet {
namespace {

int exit_code_of_sheet(const std::string& arguments) {
  const std::string command =
      WAYMARK_BUILD_DIR "/waymark-marker-sheet " + arguments + " > /dev/null 2>&1";
  const int status = std::system(command.c_str());
  return WIFEXITED(status) ? WEXITSTATUS(status) : -1;
}

TEST(MarkerSheetProgram, OptionsOfPngsAreRefusedWithAPdf) {
  const evaluate::TemporaryFolder folder;
  const std::string pdf = " --ids 0 --size-m 0.1 --pdf " + (folder.path() / "a.pdf").string();
  const std::string sheets = (folder.path() / "sheets").string();
  EXPECT_EQ(exit_code_of_sheet("--dpi 600" + pdf), 2);
  EXPECT_EQ(exit_code_of_sheet("--out " + sheets + pdf), 2);
  EXPECT_EQ(exit_code_of_sheet(pdf), 0);
  EXPECT_EQ(exit_code_of_sheet("--ids 0 --size-m 0.1 --dpi 600 --out " + sheets), 0);
}

}  // namespace
}  // namespace waymark::marker_sheet

// SPDX-License-Identifier: BSD-3-Clause
// Files that the import tests read and write.
#pragma once

#include "common/log/log_file.hpp"
#include "common/messages/codec.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <vector>

namespace waymark {

inline std::filesystem::path data_file(const std::string& name) {
  return std::filesystem::path{WAYMARK_SOURCE_DIR} / "tests/data/import" / name;
}

/// An empty folder for the running test.
inline std::filesystem::path test_folder() {
  const auto* test = ::testing::UnitTest::GetInstance()->current_test_info();
  const auto folder = std::filesystem::path{::testing::TempDir()} / "waymark_import" /
                      (std::string{test->test_suite_name()} + "." + test->name());
  static std::filesystem::path last;
  if (folder != last) std::filesystem::remove_all(folder);
  last = folder;
  std::filesystem::create_directories(folder);
  return folder;
}

inline std::string read_file(const std::filesystem::path& path) {
  std::ifstream file{path, std::ios::binary};
  return {std::istreambuf_iterator<char>{file}, {}};
}

inline std::filesystem::path write_file(const std::string& name, const std::string& text) {
  const auto path = test_folder() / name;
  std::filesystem::remove(path);  // some file systems wait for the disk when a file is truncated
  std::ofstream{path, std::ios::binary} << text;
  return path;
}

inline std::filesystem::path write_log(const std::string& name,
                                       const std::vector<Message>& messages) {
  const auto path = test_folder() / name;
  LogWriter writer{path};
  for (const Message& message : messages)
    writer.write(message);
  writer.close();
  return path;
}

}  // namespace waymark

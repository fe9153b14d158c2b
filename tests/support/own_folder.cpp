// SPDX-License-Identifier: BSD-3-Clause
// Part of every test program: makes ::testing::TempDir() a folder of this process alone, which is
// removed when the process ends. So tests that run at the same time do not interfere, and none
// fills the disk.
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <stdexcept>
#include <string>
#include <system_error>

namespace waymark {
namespace {

class OwnFolder {
 public:
  OwnFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "waymark-test-XXXXXX").string();
    if (::mkdtemp(name.data()) == nullptr) throw std::runtime_error{"no folder in " + name};
    path_ = name;
    ::setenv("TEST_TMPDIR", path_.c_str(), 1);  // read by ::testing::TempDir()
  }

  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;

  ~OwnFolder() {
    if (::getpid() != owner_) return;  // a child process that a test has forked
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }

 private:
  pid_t owner_{::getpid()};
  std::filesystem::path path_{};
};

const OwnFolder kOwnFolder;

}  // namespace
}  // namespace waymark

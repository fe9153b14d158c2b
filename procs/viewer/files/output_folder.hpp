// SPDX-License-Identifier: BSD-3-Clause
// The viewer's output folder. Files are written atomically; failures are recorded.
#pragma once

#include <filesystem>
#include <set>
#include <string>
#include <string_view>

namespace waymark::viewer {

class OutputFolder {
 public:
  /// Creates the folder if need be.
  /// @throws SetupError when files cannot be written there.
  explicit OutputFolder(std::filesystem::path folder);

  /// Writes one file. A failure is logged and recorded, not thrown.
  void write(const std::string& name, std::string_view bytes);

  /// Removes a file of an earlier run, if there is one.
  void remove(const std::string& name);

  const std::filesystem::path& path() const { return folder_; }

  /// Names of the files whose writing or removal has failed at least once.
  const std::set<std::string>& failed_files() const { return failed_files_; }

 private:
  std::filesystem::path folder_;
  std::set<std::string> failed_files_;
};

}  // namespace waymark::viewer

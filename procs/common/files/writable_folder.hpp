// SPDX-License-Identifier: BSD-3-Clause
// Folders for output: found wanting before the work, not after it.
#pragma once

#include <filesystem>

namespace waymark {

/// Creates the folder if need be, and tries whether files can be written there; leaves none.
/// @throws SetupError when they cannot.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace waymark

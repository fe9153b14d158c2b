// SPDX-License-Identifier: BSD-3-Clause
// Output folders, checked before the work begins.
#pragma once

#include <filesystem>

namespace waymark {

/// Creates the folder if it does not exist, and checks by a temporary file that it is writable.
/// @throws SetupError when it cannot be created or written to.
void make_writable_folder(const std::filesystem::path& folder);

}  // namespace waymark

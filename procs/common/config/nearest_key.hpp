// SPDX-License-Identifier: BSD-3-Clause
// Finds the key that a misspelt one probably means.
#pragma once

#include <string>
#include <vector>

namespace waymark::config_detail {

/// The candidate with the smallest edit distance to `key`; empty if none is close.
std::string nearest_key(const std::string& key, const std::vector<std::string>& candidates);

}  // namespace waymark::config_detail

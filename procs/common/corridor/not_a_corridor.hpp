// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace waymark::corridor {

/// What the map shows has no length from end to end; says why.
class NotACorridor : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace waymark::corridor

// SPDX-License-Identifier: BSD-3-Clause
// Problems of usage or set-up that the user has to fix.
#pragma once

#include <stdexcept>

namespace waymark {

/// A usage or set-up problem (exit code 2): what, where, what to do.
class SetupError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace waymark

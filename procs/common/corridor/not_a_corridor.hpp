// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <stdexcept>

namespace waymark::corridor {

/// The map shows no corridor whose length could be measured; what() says why.
class NotACorridor : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

}  // namespace waymark::corridor

// SPDX-License-Identifier: BSD-3-Clause
// Why a message was not accepted.
#pragma once

#include <string_view>

namespace waymark {

enum class RejectReason {
  kNone,
  kTooLarge,
  kTruncated,  ///< shorter than its length fields say
  kWrongType,  ///< fingerprint of another type
  kBadLength,  ///< negative length, or a string without exactly one zero, at its end
  kTrailingBytes,
  kNotFinite,     ///< NaN or infinity where none may be
  kInconsistent,  ///< arrays that must agree in size do not, or a field has no such value
  kOutOfBounds,   ///< a number beyond the limits in bounds.hpp
  kBadTime,       ///< utime negative or beyond bounds.hpp, or a beam's time far from it
};

std::string_view to_string(RejectReason reason);

}  // namespace waymark

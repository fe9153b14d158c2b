// SPDX-License-Identifier: BSD-3-Clause
#include "sim/core/span.hpp"

namespace waymark {

void Span::describe(Fields& fields) {
  fields.field("from_s", from_s, kNotNegative, "begins at this time");
  fields.field("to_s", to_s, kNotNegative, "is over at this time");
  fields.field("from_m", from_m, kNotNegative, "begins after this much of the route");
  fields.field("to_m", to_m, kNotNegative, "is over after this much of the route");
}

void Trigger::describe(Fields& fields) {
  fields.field("at_s", at_s, kNotNegative, "not before this time");
  fields.field("at_m", at_m, kNotNegative, "not before this much of the route");
}

}  // namespace waymark

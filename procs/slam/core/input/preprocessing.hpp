// SPDX-License-Identifier: BSD-3-Clause
// Parameters of combining sensor values into observations.
#pragma once

namespace waymark {

class Fields;

struct Preprocessing {
  double beam_tolerance_m{0.08};
  double view_margin_rad{0.1};
  double detectable_px{66.0};
  double max_sigma_m{0.05};
  double marker_wait_s{0.25};
  double scan_wait_s{1.0};

  void describe(Fields& fields);
};

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "common/runtime/replay_report.hpp"

#include "common/geometry/rounded.hpp"

#include <nlohmann/json.hpp>

namespace waymark {

std::string to_json(const ReplayReport& report, const Counters& counters) {
  nlohmann::ordered_json json;
  json["messages"] = report.messages;
  json["log_s"] = rounded(report.log_s, 1e3);
  json["wall_s"] = rounded(report.wall_s, 1e3);
  json["real_time_factor"] = rounded(report.real_time_factor(), 1e3);
  json["peak_memory_mb"] = rounded(report.peak_memory_mb, 1e3);
  json["counters"] = nlohmann::ordered_json::array();
  for (const auto& [name, count] : counters.all()) {
    if (count.value == 0) continue;
    json["counters"].push_back(
        {{"name", name}, {"kind", to_string(count.kind)}, {"value", count.value}});
  }
  return json.dump(2, ' ', false, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

}  // namespace waymark

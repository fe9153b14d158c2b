// SPDX-License-Identifier: BSD-3-Clause
#include "doctor/report.hpp"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>

namespace waymark {
namespace {

std::string_view to_string(Verdict verdict) {
  switch (verdict) {
    case Verdict::kPass:
      return "PASS";
    case Verdict::kWarn:
      return "WARN";
    case Verdict::kFail:
      return "FAIL";
    case Verdict::kUnchecked:
      return "----";
  }
  return "";
}

}  // namespace

std::string to_text(const std::vector<Check>& checks) {
  std::string text;
  for (const Check& check : checks) {
    text += fmt::format("{}  {:<24} {}\n", to_string(check.verdict), check.name, check.finding);
    if (check.verdict != Verdict::kPass && !check.remedy.empty())
      text += fmt::format("{:32}-> {}\n", "", check.remedy);
  }
  const auto count = [&](Verdict verdict) {
    return std::ranges::count(checks, verdict, &Check::verdict);
  };
  return text + fmt::format("{} PASS, {} WARN, {} FAIL, {} could not be checked\n",
                            count(Verdict::kPass), count(Verdict::kWarn), count(Verdict::kFail),
                            count(Verdict::kUnchecked));
}

std::string to_json(const Diagnosis& diagnosis, const DoctorInput& input) {
  nlohmann::ordered_json json;
  json["checks"] = nlohmann::ordered_json::array();
  for (const Check& check : diagnosis.checks) {
    const bool is_checked = check.verdict != Verdict::kUnchecked;
    nlohmann::ordered_json entry{{"name", check.name},
                                 {"verdict", is_checked ? to_string(check.verdict) : "UNCHECKED"},
                                 {"value", nullptr},
                                 {"finding", check.finding},
                                 {"remedy", check.remedy}};
    if (check.value) entry["value"] = *check.value;
    json["checks"].push_back(std::move(entry));
  }
  json["channels"] = nlohmann::ordered_json::object();
  for (const auto& [channel, traffic] : input.channels) {
    json["channels"][channel] = {{"messages", traffic.messages},
                                 {"bytes", traffic.bytes},
                                 {"largest_bytes", traffic.largest_bytes}};
  }
  return json.dump(2, ' ', true, nlohmann::ordered_json::error_handler_t::replace) + "\n";
}

std::string to_robot_toml(const Diagnosis& diagnosis, const std::filesystem::path& log) {
  std::string text = fmt::format("# By waymark-doctor, from {}:\n", log.filename().string());
  for (const Check& check : diagnosis.checks) {
    if (check.verdict != Verdict::kPass)
      text += fmt::format("# {} {}: {}\n", to_string(check.verdict), check.name, check.finding);
  }
  return text + dump_robot_config(diagnosis.robot);
}

bool any_failed(const std::vector<Check>& checks) {
  return std::ranges::count(checks, Verdict::kFail, &Check::verdict) > 0;
}

}  // namespace waymark

// SPDX-License-Identifier: BSD-3-Clause
#include "faults/faulty_run.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/log/log_file.hpp"
#include "faults/injector.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <charconv>
#include <sstream>
#include <stdexcept>

namespace waymark::faults {
namespace {

namespace fs = std::filesystem;

/// The part of a scenario that is read here.
struct SeedPart {
  struct Run {
    std::int64_t seed{1};

    void describe(Fields& fields) { fields.field("seed", seed, kNotNegative, "of the run"); }
  };

  Run run{};

  void describe(Fields& fields) { fields.section("run", run); }
};

void check_folders(const fs::path& run_dir, const fs::path& out_dir) {
  if (!fs::is_regular_file(run_dir / "run.lcm"))
    throw SetupError{run_dir.string() + ": no run.lcm in it; give the folder of a recorded run"};
  std::error_code none;  // equivalent() is false if out_dir does not exist yet
  if (fs::equivalent(run_dir, out_dir, none))
    throw SetupError{out_dir.string() +
                     ": is the recorded run itself; give another folder for the faulty one"};
  if (fs::exists(run_dir / kMark))
    throw SetupError{
        (run_dir / kMark).string() +
        ": says that this run has faults already; give the folder of the recorded run"};
  if (fs::exists(out_dir / "run.lcm") && !fs::exists(out_dir / kMark))
    throw SetupError{(out_dir / "run.lcm").string() +
                     ": is there already, and not of a faulty run; give another folder"};
}

bool is_same_drive(const fs::path& run_dir, const fs::path& out_dir) {
  const auto truth = [](const fs::path& folder) {
    const fs::path file = folder / "truth.tum";
    return fs::exists(file) ? read_whole_file(file) : "";
  };
  return truth(run_dir) == truth(out_dir);
}

bool are_applied(const FaultConfig& faults, const fs::path& out_dir) {
  const auto text = [](const FaultConfig& config) {
    return dump_config(VariantsFile{{Variant{.faults = config}}});
  };
  const auto applied = load_config<VariantsFile>({{out_dir / kMark}, {}});
  return applied.variant.size() == 1 && text(applied.variant.front().faults) == text(faults);
}

/// Checks that replays in the folder will still belong to its log: replays of another log must not
/// stay beside it.
void check_replays(const fs::path& run_dir, const FaultConfig& faults, const fs::path& out_dir) {
  if (!fs::exists(out_dir / kMark)) return;
  if (is_same_drive(run_dir, out_dir) && are_applied(faults, out_dir)) return;
  for (const fs::directory_entry& row : fs::directory_iterator{out_dir}) {
    if (fs::exists(row.path() / "config.toml")) {
      throw SetupError{row.path().string() +
                       ": is a replay of another drive or other faults; give another folder, or "
                       "delete this run"};
    }
  }
}

bool is_output_of_slam(const Message& message) {
  return message.channel.starts_with("SLAM_");
}

LogContent content_of(const fs::path& log) {
  LogContent content;
  LogReader reader{log};
  while (const auto message = reader.next())
    content.add(*message);
  return content;
}

/// Files beside the log, by name, with the new ids.
std::map<std::string, std::string> files_beside_log(const fs::path& run_dir,
                                                    const FaultConfig& faults) {
  const fs::path moves = run_dir / "truth_marker_moves.csv";
  if (fs::exists(moves) && faults.changes_ids())
    throw std::runtime_error{moves.string() + ": markers that move cannot have other ids, too"};
  std::map<std::string, std::string> files;
  for (const char* name :
       {"scenario.toml", "robot.toml", "truth.tum", "truth_markers.csv", "truth_marker_moves.csv"})
    if (fs::exists(run_dir / name)) files[name] = read_whole_file(run_dir / name);
  if (const auto markers = files.find("truth_markers.csv");
      markers != files.end() && faults.changes_ids())
    markers->second = renamed_markers(markers->second, faults, run_dir / "truth_markers.csv");
  return files;
}

/// Injects the faults without writing.
/// @throws SetupError naming the faults when none of them affects the log.
void check_effect(const fs::path& log, const Variant& variant, Injector injector) {
  for (LogReader reader{log}; const auto message = reader.next();)
    if (!is_output_of_slam(*message)) injector.apply(*message);
  const std::vector<std::string> missed = injector.never_injected();
  if (missed.empty() || missed.size() < variant.faults.configured().size()) return;
  throw SetupError{fmt::format(
      "{}: not injected, because nothing in the log is affected: {}; look at its times and ids",
      variant.name, fmt::join(missed, ", "))};
}

}  // namespace

std::string renamed_markers(const std::string& csv, const FaultConfig& faults,
                            const fs::path& file) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  std::string renamed = line + "\n";
  std::map<int, int> instances;
  for (int number = 2; std::getline(lines, line); ++number) {
    if (line.empty()) continue;
    const std::size_t first = std::min(line.find(','), line.size());
    const std::size_t second = line.find(',', first + 1);
    int recorded_id = 0;
    const char* const end = line.data() + first;
    const auto parsed = std::from_chars(line.data(), end, recorded_id);
    if (parsed.ec != std::errc{} || parsed.ptr != end || second == std::string::npos) {
      throw std::runtime_error{fmt::format("{}:{}: got '{}', expected id,instance and more columns",
                                           file.string(), number, line)};
    }
    const int id = faults.id_of(recorded_id);
    renamed += std::to_string(id) + "," + std::to_string(instances[id]++) + line.substr(second);
    renamed += "\n";
  }
  return renamed;
}

std::map<std::string, std::int64_t> write_faulty_run(const fs::path& run_dir,
                                                     const Variant& variant,
                                                     const fs::path& out_dir) {
  check_folders(run_dir, out_dir);
  check_replays(run_dir, variant.faults, out_dir);
  const fs::path log = run_dir / "run.lcm";
  const auto files = files_beside_log(run_dir, variant.faults);
  const fs::path scenario = run_dir / "scenario.toml";
  const std::int64_t seed = fs::exists(scenario) ? load_part<SeedPart>(scenario).run.seed : 1;
  const LogContent content = content_of(log);
  Injector injector{variant.faults, static_cast<std::uint64_t>(seed), content};
  check_effect(log, variant, injector);
  make_writable_folder(out_dir);
  write_whole_file(out_dir / kMark, dump_config(VariantsFile{{variant}}));
  for (const auto& [name, text] : files)
    write_whole_file(out_dir / name, text);
  write_whole_file(out_dir / "expect.toml", dump_config(ExpectFile{variant.expect}));
  LogReader reader{log};
  LogWriter writer{out_dir / "run.lcm"};
  while (const auto message = reader.next()) {
    if (is_output_of_slam(*message)) continue;
    if (const auto faulty = injector.apply(*message)) writer.write(*faulty);
  }
  writer.close();
  return injector.counts();
}

}  // namespace waymark::faults

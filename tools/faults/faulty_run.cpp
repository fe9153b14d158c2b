// SPDX-License-Identifier: BSD-3-Clause
#include "faults/faulty_run.hpp"

#include "common/errors/setup_error.hpp"
#include "common/files/whole_file.hpp"
#include "common/files/writable_folder.hpp"
#include "common/log/log_file.hpp"
#include "faults/injector.hpp"

#include <sstream>
#include <stdexcept>

namespace waymark::faults {
namespace {

namespace fs = std::filesystem;

/// The part of a scenario that is read.
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

void copy_truth(const fs::path& run_dir, const FaultConfig& faults, const fs::path& out_dir) {
  if (const fs::path moves = run_dir / "truth_marker_moves.csv"; fs::exists(moves)) {
    if (faults.changes_ids())
      throw std::runtime_error{moves.string() + ": markers that move cannot have other ids, too"};
    write_whole_file(out_dir / moves.filename(), read_whole_file(moves));
  }
  for (const char* name : {"scenario.toml", "robot.toml", "truth.tum", "truth_markers.csv"}) {
    if (!fs::exists(run_dir / name)) continue;
    const std::string text = read_whole_file(run_dir / name);
    const bool has_ids = std::string_view{name} == "truth_markers.csv" && faults.changes_ids();
    write_whole_file(out_dir / name, has_ids ? renamed_markers(text, faults) : text);
  }
}

}  // namespace

std::string renamed_markers(const std::string& csv, const FaultConfig& faults) {
  std::istringstream lines{csv};
  std::string line;
  std::getline(lines, line);
  std::string renamed = line + "\n";
  std::map<int, int> instances;
  while (std::getline(lines, line)) {
    const std::size_t first = line.find(',');
    const std::size_t second = first == std::string::npos ? first : line.find(',', first + 1);
    if (second == std::string::npos) continue;
    const int id = faults.id_of(std::stoi(line));
    renamed += std::to_string(id) + "," + std::to_string(instances[id]++) + line.substr(second);
    renamed += "\n";
  }
  return renamed;
}

std::map<std::string, std::int64_t> write_faulty_run(const fs::path& run_dir,
                                                     const Variant& variant,
                                                     const fs::path& out_dir) {
  check_folders(run_dir, out_dir);
  const fs::path log = run_dir / "run.lcm";
  make_writable_folder(out_dir);
  write_whole_file(out_dir / kMark, dump_config(VariantsFile{{variant}}));
  copy_truth(run_dir, variant.faults, out_dir);
  write_whole_file(out_dir / "expect.toml", dump_config(ExpectFile{variant.expect}));

  const fs::path scenario = run_dir / "scenario.toml";
  const std::int64_t seed = fs::exists(scenario) ? load_part<SeedPart>(scenario).run.seed : 1;
  const LogContent content = content_of(log);
  Injector injector{variant.faults, static_cast<std::uint64_t>(seed), content};
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

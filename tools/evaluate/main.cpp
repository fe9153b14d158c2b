// SPDX-License-Identifier: BSD-3-Clause
// waymark-evaluate: measures the errors of maps and trajectories.
#include "common/command_line/command_line.hpp"
#include "common/command_line/run_tool.hpp"
#include "evaluate/commands.hpp"

#include <unistd.h>

#include <cerrno>
#include <functional>
#include <system_error>

namespace {

using namespace waymark::evaluate;
using waymark::Command;

struct Arguments {
  std::filesystem::path map_yaml{};
  std::filesystem::path run_dir{};
  std::filesystem::path trajectory{};
  std::filesystem::path reference{};
  std::filesystem::path relations{};
  std::vector<std::filesystem::path> row_dirs{};
  std::vector<std::string> estimators{};
  EvaluationOptions options{};
  Output output{};
};

using Action = std::function<int()>;

void add_alignment(Command& command, Arguments& arguments) {
  command.add_choice(
      "--align", arguments.options.alignment,
      {{"origin", Alignment::kOrigin}, {"se2", Alignment::kSe2}},
      "along, across and heading errors after alignment on the first pose (origin; default) or "
      "after the best rigid fit (se2)");
}

void add_output(Command& command, Arguments& arguments, const std::string& json_help) {
  command.add_flag("--json", arguments.output.json, json_help);
}

void add_tolerant(Command& command, Arguments& arguments,
                  const std::string& what = "lines were skipped (they are named in any case)") {
  command.add_flag("--tolerant", arguments.output.tolerant, "exit with 0 although " + what);
}

void add_true_length(Command& command, Arguments& arguments) {
  command
      .add_option("--true-length-m", arguments.options.true_length_m,
                  "true corridor length between inner faces [m], for the accuracy")
      .check(waymark::positive_number());
}

void add_length(Command& program, Arguments& arguments, Action& chosen) {
  Command command = program.add_subcommand(
      "length", "corridor length on a map image alone, from end wall to end wall");
  command.add_option("MAP", arguments.map_yaml, "map.yaml beside its PGM image").required();
  add_true_length(command, arguments);
  add_output(command, arguments, "print JSON");
  command.when_given([&] {
    chosen = [&] {
      return run_length(arguments.map_yaml, arguments.options.true_length_m, arguments.output);
    };
  });
}

void add_run(Command& program, Arguments& arguments, Action& chosen) {
  Command command = program.add_subcommand(
      "run", "every estimator folder of a run: writes metrics.json, results.json, results.md");
  command
      .add_option("RUN_DIR", arguments.run_dir,
                  "folder with truth.tum, truth_markers.csv, scenario.toml (each if there is one) "
                  "and one sub-folder per estimator")
      .required();
  command.add_option("--estimators", arguments.estimators, "only these, separated by commas")
      .delimiter(',');
  command
      .add_option("--marker-gate-m", arguments.options.marker_gate_m,
                  "a marker estimated further from its true place counts as missing and spurious")
      .check(waymark::positive_number())
      .show_default();
  command.add_option("--mapped-in", arguments.options.mapped_in,
                     "run folder that made the map which this run has loaded: errors are in that "
                     "map's frame (ate_frame_m), without alignment");
  add_true_length(command, arguments);
  add_alignment(command, arguments);
  add_output(command, arguments, "print results.json instead of the table");
  add_tolerant(command, arguments);
  command.when_given([&] {
    chosen = [&] {
      return run_run(arguments.run_dir, arguments.estimators, arguments.options, arguments.output);
    };
  });
}

void add_trajectory(Command& program, Arguments& arguments, Action& chosen) {
  Command command =
      program.add_subcommand("trajectory", "a trajectory against a reference: ATE and RPE");
  command.add_option("ESTIMATE", arguments.trajectory, "TUM file: t x y z qx qy qz qw").required();
  command.add_option("REFERENCE", arguments.reference, "TUM file, interpolated").required();
  add_alignment(command, arguments);
  add_output(command, arguments, "print JSON");
  add_tolerant(command, arguments,
               "lines were skipped or the two overlap in part only (both are named in any case)");
  command.when_given([&] {
    chosen = [&] {
      return run_trajectory(arguments.trajectory, arguments.reference, arguments.options.alignment,
                            arguments.output);
    };
  });
}

void add_relations(Command& program, Arguments& arguments, Action& chosen) {
  Command command = program.add_subcommand(
      "relations", "a trajectory against known relative poses (Kümmerle et al. 2009)");
  command.add_option("TRAJECTORY", arguments.trajectory, "TUM file: t x y z qx qy qz qw")
      .required();
  command.add_option("RELATIONS", arguments.relations, "lines t1 t2 x y z roll pitch yaw")
      .required();
  add_output(command, arguments, "print JSON");
  add_tolerant(command, arguments);
  command.when_given([&] {
    chosen = [&] {
      return run_relations(arguments.trajectory, arguments.relations, arguments.output);
    };
  });
}

void add_sweep(Command& program, Arguments& arguments, Action& chosen) {
  Command command = program.add_subcommand(
      "sweep", "all runs of deploy/sweep.sh: writes results.md, results.csv, runs.csv, index.html");
  command.add_option("DIR", arguments.run_dir, "the sweep's folder").required();
  add_output(command, arguments, "print JSON instead of the table");
  add_tolerant(command, arguments);
  command.when_given([&] {
    chosen = [&] {
      return run_sweep(arguments.run_dir, arguments.output);
    };
  });
}

void add_consistency(Command& program, Arguments& arguments, Action& chosen) {
  Command command = program.add_subcommand(
      "consistency", "mean NEES per metre over many runs, against its 95 % band");
  command
      .add_option("ROW_DIR", arguments.row_dirs,
                  "estimator folders of several runs, each with a stations.csv (see run)")
      .required();
  add_output(command, arguments, "print JSON");
  command.when_given([&] {
    chosen = [&] {
      return run_consistency(arguments.row_dirs, arguments.output);
    };
  });
}

/// Replaces this process by waymark-placement, which is in the same folder.
int run_placement_program(const std::vector<std::string>& arguments) {
  const std::string program =
      std::filesystem::read_symlink("/proc/self/exe").replace_filename("waymark-placement");
  std::string name = "waymark-evaluate placement";
  std::vector<char*> argv{name.data()};
  for (const std::string& argument : arguments)
    argv.push_back(const_cast<char*>(argument.c_str()));
  argv.push_back(nullptr);
  ::execv(program.c_str(), argv.data());
  throw std::system_error{errno, std::generic_category(), program};
}

void add_placement(Command& program, Action& chosen) {
  Command command = program.add_subcommand(
      "placement", "where the estimate is too uncertain, and where to hang new markers");
  command.pass_on_the_rest();
  command.when_given([command, &chosen] {
    chosen = [command] {
      return run_placement_program(command.rest());
    };
  });
}

}  // namespace

int main(int argc, char** argv) {
  Arguments arguments;
  Action chosen;
  waymark::Program program{
      "Measures the errors of maps and trajectories.\n"
      "Exit code: 0 success; 1 a figure is missing or of a part of the run, or lines were skipped; "
      "2 wrong usage or files.",
      "waymark-evaluate"};
  program.require_subcommand();
  add_length(program, arguments, chosen);
  add_run(program, arguments, chosen);
  add_trajectory(program, arguments, chosen);
  add_relations(program, arguments, chosen);
  add_sweep(program, arguments, chosen);
  add_consistency(program, arguments, chosen);
  add_placement(program, chosen);
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  return waymark::run_tool("waymark-evaluate", chosen, waymark::kExitUsage);
}

// SPDX-License-Identifier: BSD-3-Clause
// waymark-export: converts runs to formats of other programs.
#include "common/command_line/command_line.hpp"
#include "common/log/log_file.hpp"
#include "common/runtime/guard.hpp"
#include "common/runtime/replay.hpp"
#include "export/mcap_export.hpp"

int main(int argc, char** argv) {
  using namespace waymark;
  ProcessOptions options;
  std::filesystem::path out;

  Program program{
      "Writes runs in the formats of other programs.\n"
      "Exit code: 0 fine; 1 a log is damaged or not understood, or the disk became full;\n"
      "2 wrong usage, no such log, or nothing can be written there.",
      "waymark-export"};
  program.require_subcommand();
  Command mcap = program.add_subcommand(
      "mcap", "MCAP for Foxglove: map, scans, poses, frames, markers, camera");
  mcap.add_option("log", options.logs,
                  "LCM log; of several, a channel is taken from the last one that has it (run.lcm "
                  "ROW/slam.lcm)")
      .required();
  mcap.add_option("--out", out, "the MCAP file").required();
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  return run_guarded({"export", "", false}, [&] {
    protect_inputs("--out", out, options.logs);
    Inbox inbox;
    Outbox outbox;
    exporting::McapExport node{out, inbox};
    return run_replay(options, node, inbox, outbox);
  });
}

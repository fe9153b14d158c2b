// SPDX-License-Identifier: BSD-3-Clause
// waymark-faults: copies a recorded run with faults in its messages.
#include "common/command_line/command_line.hpp"
#include "common/command_line/run_tool.hpp"
#include "common/log/log_file.hpp"
#include "faults/faulty_run.hpp"

#include <fmt/format.h>

#include <cstdio>

namespace {

struct Arguments {
  std::filesystem::path run_dir{};
  std::filesystem::path variants{};
  std::filesystem::path out{};
  std::string variant{};
  bool list{};
  bool explain{};
};

int run(const Arguments& arguments) {
  using namespace waymark;
  using namespace waymark::faults;
  if (arguments.explain) {
    fmt::print("{}", dump_config(VariantsFile{{Variant{.name = "example"}}}));
    return kExitOk;
  }
  const auto file = load_config<VariantsFile>({{arguments.variants}, {}});
  if (arguments.list) {
    for (const Variant& variant : file.variant)
      fmt::print("{}\n", variant.name);
    return kExitOk;
  }
  const Variant& variant = file.named(arguments.variant);
  for (const std::string_view name : kFiles)
    protect_inputs("--out", arguments.out / name, {arguments.variants});
  for (const auto& [name, count] : write_faulty_run(arguments.run_dir, variant, arguments.out))
    fmt::print("{}: {}\n", name, count);
  return kExitOk;
}

}  // namespace

int main(int argc, char** argv) {
  using namespace waymark;
  Arguments arguments;
  Program program{
      "Copies a recorded run with faults in its messages: wrong ids, ghosts, flipped poses, lost "
      "messages, wrong odometry. The same run and variant give the same bytes. The applied faults "
      "are in variant_applied.toml beside the log.",
      "waymark-faults"};
  program.add_option("RUN_DIR", arguments.run_dir,
                     "folder with run.lcm, robot.toml, scenario.toml and the truth");
  program.add_option("--variants", arguments.variants,
                     "TOML file with [[variant]] tables, such as deploy/faults/messages.toml");
  program.add_option("--variant", arguments.variant, "name of the one to apply");
  program.add_option("--out", arguments.out, "folder for the faulty run");
  program.add_flag("--list", arguments.list,
                   "print the names of the variants of --variants, and exit");
  program.add_flag("--explain", arguments.explain,
                   "print a variant with every key explained, and exit");
  if (const auto exit_code = program.parse(argc, argv)) return *exit_code;
  const bool is_complete = !arguments.run_dir.empty() && !arguments.variants.empty() &&
                           !arguments.variant.empty() && !arguments.out.empty();
  const bool is_list = arguments.list && !arguments.variants.empty();
  if (arguments.list && !is_list)
    return program.refuse_without("--variants, the file whose variants are listed,");
  if (!is_complete && !is_list && !arguments.explain)
    return program.refuse_without(
        "RUN_DIR, --variants, --variant and --out (or --list, --explain)");
  return run_tool("waymark-faults", [&] { return run(arguments); });
}

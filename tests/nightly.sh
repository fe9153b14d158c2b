#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# What takes too long for every change; about four hours on two cores. A part that fails does not stop the others.
#
# usage: tests/nightly.sh [PART...]
#   PART  sanitizers (unit, property and statistics tests with AddressSanitizer and UBSan), threads (the stack under
#         ThreadSanitizer), fuzz (random inputs guided by coverage, ten minutes for each target), tidy (clang-tidy over all
#         files), benchmarks (whether they compile); default: all, in this order
# Exit codes: 0 all passed, 1 some failed: they are named at the end, 2 bad usage.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../deploy/common.sh"

readonly kParts=(sanitizers threads fuzz tidy benchmarks)
case ${1:-} in --help | -h) print_usage && exit 0 ;; esac
parts=("$@")
((${#parts[@]} > 0)) || parts=("${kParts[@]}")
for part in "${parts[@]}"; do
  [[ " ${kParts[*]} " == *" $part "* ]] || usage_error "no part '$part'; there are ${kParts[*]}"
done

sanitizers() {
  build asan unit_tests property_tests statistics_tests
  ctest --preset asan-statistics
}
threads() { tests/simulation/thread_sanitizer.sh; }
fuzz() { tests/fuzz/run.sh --seconds 600; }
tidy() { tests/tidy.sh; }
benchmarks() { build release benchmarks; }

exec </dev/null  # never waits for an answer
"$deploy_dir/install-deps.sh" --tests --fuzz
cd "$source_dir"
failed=()
for part in "${parts[@]}"; do
  say "$part"
  ("$part") || failed+=("$part")
done
((${#failed[@]} == 0)) || die $kExitFailed "failed: ${failed[*]}"
say "passed: ${parts[*]}"

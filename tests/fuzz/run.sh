#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Random inputs for everything that reads bytes of others, with AddressSanitizer and UndefinedBehaviorSanitizer: guided by
# coverage (libFuzzer). Goes on from its corpus, which begins with the messages, the map and the files of a short run.
#
# usage: tests/fuzz/run.sh [options] [TARGET...]
#   TARGET       messages datagram log map config survey carmen mbot rosbag jpeg slam command_line page_text request
#                (default: all, one after the other)
#   --runs N     executions of each (default: 100000)
#   --seconds N  instead so many seconds for each
#   --corpus DIR (default: build/fuzz/corpus)
#   --unguided   without clang and coverage, as .ci/run does: inputs of the corpus with a few random changes each, taken by
#                programs of build/asan; the corpus stays as it is. Not for slam, and not with --seconds.
#
# An input that crashes, takes more than 2 s under the sanitizers (slam: 20 s, for 200 messages; request: 20 s, for the
# server's threads run at a lower priority), or allocates more than 16 MB at once (map, slam: 64 MB, for the table of tiles of
# a large building; rosbag: 300 MB, for a chunk) is kept in CORPUS/findings; "build/fuzz/tests/fuzz/fuzz_TARGET FILE"
# repeats it (--unguided: build/asan). Exit codes: 0 none, 1 findings, 2 bad usage.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/../../deploy/common.sh"

readonly kTargets=(messages datagram log map config survey carmen mbot rosbag jpeg slam command_line page_text request)
readonly kMaxInput_bytes=65536
declare -rA max_MB=([map]=64 [slam]=64 [rosbag]=300) longest_s=([slam]=20 [request]=20)
amount=-runs=100000 targets=() corpus=$source_dir/build/fuzz/corpus preset=fuzz
while (($# > 0)); do
  case $1 in
    --help | -h) print_usage && exit 0 ;;
    --runs) need_value "$@" && need_count "$1" "$2" && amount=-runs=$2 && shift 2 ;;
    --seconds) need_value "$@" && need_count "$1" "$2" && amount=-max_total_time=$2 && shift 2 ;;
    --corpus) need_value "$@" && corpus=$2 && shift 2 ;;
    --unguided) preset=asan && shift ;;
    -*) usage_error "unknown option '$1'" ;;
    *)
      [[ " ${kTargets[*]} " == *" $1 "* ]] || usage_error "no target '$1'; there are ${kTargets[*]}"
      targets+=("$1") && shift
      ;;
  esac
done
((${#targets[@]} > 0)) || targets=("${kTargets[@]}")
if [[ $preset == fuzz ]]; then
  command -v clang++-16 >/dev/null || die $kExitUsage "no clang++-16 here; deploy/install-deps.sh --fuzz installs it"
elif [[ " ${targets[*]} " == *" slam "* || $amount != -runs=* ]]; then
  usage_error "--unguided knows no target slam and no --seconds; name the other targets"
fi
programs=$source_dir/build/$preset/tests/fuzz

# make_seeds: from a live run of the release's programs.
make_seeds() {
  local work
  work=$(mktemp -d)
  "$source_dir/tests/with_network.sh" "$source_dir/deploy/launch.sh" "$source_dir/tests/data/scenarios/smallest.toml" \
    --out "$work/run" --save-map "$work/short.map.lcm" >"$work/output" 2>&1 ||
    die $kExitFailed "the run for the first inputs failed: see $work/output"
  "$programs/fuzz_seeds" "$work/run" "$work/short.map.lcm" "$corpus"
  rm -rf -- "$work"
}

build "$preset" fuzz_seeds "${targets[@]/#/fuzz_}"
[[ -d $corpus/messages && -d $corpus/request ]] || { build release waymark-{sim,detector,slam,viewer,recorder} && make_seeds; }
[[ -d $corpus/rosbag ]] || /usr/bin/python3 -B "$source_dir/tests/python/bag_drive.py" "$corpus/rosbag"
mkdir -p "$corpus/findings"
# Two frames of where memory was allocated, not thirty: a finding that is repeated shows all.
export ASAN_OPTIONS=malloc_context_size=2${ASAN_OPTIONS:+:$ASAN_OPTIONS}

failed=()
for target in "${targets[@]}"; do
  mkdir -p "$corpus/$target"
  log=$corpus/$target.log
  "$programs/fuzz_$target" "$corpus/$target" "$amount" -max_len=$kMaxInput_bytes -timeout="${longest_s[$target]:-2}" \
    -rss_limit_mb=1024 -malloc_limit_mb="${max_MB[$target]:-16}" -print_final_stats=1 -artifact_prefix="$corpus/findings/$target-" >"$log" 2>&1 ||
    failed+=("$target")
  executions=$(sed -n 's/^stat::number_of_executed_units: *//p' "$log")
  features=$(grep -oE 'cov: [0-9]+ ft: [0-9]+' "$log" | tail -n 1 || true)
  say "$target: ${executions:-some} executions, ${features:-no coverage}, $(find "$corpus/$target" -type f | wc -l) inputs"
done
((${#failed[@]} == 0)) || die $kExitFailed "findings in ${failed[*]}: see $corpus/findings and $corpus/TARGET.log"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs one estimator and the viewer on a recorded log.
#
# usage: deploy/replay.sh LOG --estimator NAME [options]
#   --config FILE    configuration of slam; may be given several times, later files win
#   --set KEY=VALUE  the same for one value; may be given several times
#   --row NAME       folder for the results inside DIR (default: the estimator's name)
#   --robot FILE     sensors and their mounting (default: robot.toml beside the log)
#   --out DIR        (default: the log's folder)
#
# Writes map, pictures, trajectory and markers into DIR/ROW (README.md, "What a run leaves"), with slam.lcm
# (what slam published), config.toml and timings.json. The seed is that of the run when its scenario.toml
# is beside the log, so that a run and its replay give the same bytes.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  log='' estimator='' row='' robot='' out='' slam_options=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --estimator | --config | --set | --row | --robot | --out) need_value "$@" ;;&
      --estimator) estimator=$2 ;;
      --config) need_file "$2" && slam_options+=(--config "$2") ;;
      --set) slam_options+=(--set "$2") ;;
      --row) row=$2 ;;
      --robot) robot=$2 ;;
      --out) out=$2 ;;
      -*) usage_error "unknown option '$1'" ;;
      *)
        [[ -z $log ]] || usage_error "one log, not both '$log' and '$1'"
        log=$1 && shift && continue
        ;;
    esac
    shift 2
  done
  [[ -n $log ]] || usage_error "no log given"
  [[ -n $estimator ]] || usage_error "--estimator is missing"
}

prepare() {
  need_file "$log"
  need_programs waymark-{slam,viewer}
  local log_folder
  log_folder=$(cd "$(dirname "$log")" && pwd)
  log=$log_folder/$(basename "$log")
  robot=${robot:-$log_folder/robot.toml}
  [[ -f $robot ]] || die $kExitUsage "no '$robot'; say with --robot which sensors the log is from"
  local seed=()
  if [[ -f $log_folder/scenario.toml ]]; then
    seed=(--set "slam.seed=$(toml_value "$log_folder/scenario.toml" run seed)")
  fi
  slam_options=(--config "$robot" "${seed[@]}" --set "slam.estimator=$estimator" "${slam_options[@]}")
  row=${row:-$estimator}
  out=$(make_folder "${out:-$log_folder}")
  folder=$(make_folder "$out/$row")
  logs=$(make_folder "$out/logs")
}

# run NAME ARGUMENTS...: one program; its words go to the log file and, being progress, to the terminal.
run() {
  local name=$1 program=$bin_dir/waymark-$1 log_file=$logs/$row.$1.log code=0
  shift
  # A pipe, for a process substitution may still be writing when its timing is read.
  { "$program" "$@" 2>&1 >&3 | tee -i "$log_file" >&2; } 3>&1 || code=$?
  ((code == 0)) || die "$code" "$name ended with code $code; its log is $log_file"
}

# timing NAME: the closing line "replayed N messages, S s of log in W s (F x real time), peak memory M MB"
# of a program's log as JSON.
timing() {
  sed -nE 's/.*replayed ([0-9]+) messages, ([0-9.]+) s of log in ([0-9.]+) s \(([0-9.]+) x real time\), peak memory ([0-9.]+) MB.*/{"messages": \1, "log_s": \2, "wall_s": \3, "real_time_factor": \4, "peak_memory_mb": \5}/p' \
    "$logs/$row.$1.log" | grep . || die $kExitFailed "no timing in $logs/$row.$1.log"
}

parse_arguments "$@"
prepare
show_progress_bars
"$bin_dir/waymark-slam" "${slam_options[@]}" --dump-config >"$folder/config.toml.tmp" || exit $?
mv "$folder/config.toml.tmp" "$folder/config.toml"
run slam "${slam_options[@]}" --log "$log" --out-log "$folder/slam.lcm"
run viewer --log "$log" --log "$folder/slam.lcm" --out "$folder"
slam_timing=$(timing slam)
viewer_timing=$(timing viewer)
printf '{"slam": %s,\n "viewer": %s}\n' "$slam_timing" "$viewer_timing" >"$folder/timings.json.tmp"
mv "$folder/timings.json.tmp" "$folder/timings.json"
say "$row is in $folder"

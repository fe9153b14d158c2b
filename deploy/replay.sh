#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs one estimator and the viewer on a recorded log, and before them the detector if the log has images (CAMERA)
# but no MARKERS.
#
# usage: deploy/replay.sh LOG [options]
#   --estimator NAME  odometry, gmapping, marker_matching or waymark (default: what waymark-slam's configuration says)
#   --config FILE     configuration of slam; may be given several times, later files win
#   --set KEY=VALUE   the same for one value; may be given several times
#   --load-map FILE   map of an earlier run (NAME.map.lcm); needs --mode
#   --mode NAME       what for: localise (it stays as it is) or extend (what is new is added)
#   --start NAME      where in it the robot is: origin (default), pose (slam.start_pose), last, anywhere
#   --save-map FILE   write the map there at the end
#   --skip-s S        leave out so many seconds of the log's beginning
#   --until-s S       read so many seconds from its beginning, and no more
#   --row NAME        folder for the results inside DIR (default: the estimator's name)
#   --robot FILE      sensors and their mounting (default: robot.toml beside the log)
#   --out DIR         (default: the log's folder)
#
# Deletes the results of an earlier replay in DIR/ROW, and its logs DIR/logs/ROW.slam.log, .viewer.log and
# .detector.log; other files there stay. A damaged log gives what is left of it, and exit code 1.
# Writes map, pictures, trajectory and markers into DIR/ROW (docs/reference.md, "What a run leaves"), with slam.lcm
# (what slam published), markers.lcm (what the detector published, if it ran), config.toml and timings.json. The
# seed is that of the run when its scenario.toml is beside the log, so that a run and its replay give the same bytes.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

parse_arguments() {
  log='' row='' robot='' out='' slam_options=() slam_files=() map_options=() part=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --estimator | --config | --set | --skip-s | --until-s | --row | --robot | --out | --load-map | --save-map | --mode | --start)
        need_value "$@"
        ;;&
      --estimator) slam_options+=(--set "slam.estimator=$2") ;;
      --config) need_file "$2" && slam_files+=("$2") && slam_options+=(--config "$2") ;;
      --set) slam_options+=(--set "$2") ;;
      --load-map) need_file "$2" && slam_files+=("$2") && map_options+=(--load-map "$2") ;;
      --save-map) slam_files+=("$2") && map_options+=(--save-map "$2") ;;
      --mode) slam_options+=(--set "slam.mode=$2") ;;
      --start) slam_options+=(--set "slam.start=$2") ;;
      --skip-s | --until-s) part+=("$1" "$2") ;;
      --row) need_row_name "$2" && row=$2 ;;
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
}

# prepare: checks all inputs and settings, and only then deletes an earlier replay's results.
prepare() {
  need_file "$log"
  need_programs waymark-{slam,viewer}
  local log_folder
  log_folder=$(cd "$(dirname "$log")" && pwd)
  log=$log_folder/$(basename "$log")
  robot=${robot:-$log_folder/robot.toml}
  [[ -f $robot ]] || die $kExitUsage "no '$robot'; say with --robot which sensors the log is from"
  check_slam
  check_detector
  row=${row:-$estimator}
  need_row_name "$row"
  out=$(make_folder "${out:-$log_folder}")
  folder=$(make_folder "$out/$row")
  logs=$(make_folder "$out/logs")
  clear_old_results
}

# check_slam: sets slam_options, estimator, and config to what they come to; adds to slam_files the survey.
check_slam() {
  local seed='' scenario=${log%/*}/scenario.toml
  if [[ -f $scenario ]]; then
    need_programs waymark-sim
    seed=$("$bin_dir/waymark-sim" --config "$scenario" --print-config run.seed) || exit $?
  fi
  slam_options=(--config "$robot" ${seed:+--set "slam.seed=$seed"} "${slam_options[@]}")
  config=$("$bin_dir/waymark-slam" "${slam_options[@]}" --dump-config) || exit $?
  estimator=$("$bin_dir/waymark-slam" "${slam_options[@]}" --print-config slam.estimator) || exit $?
  slam_files+=("$("$bin_dir/waymark-slam" "${slam_options[@]}" --print-config robot.markers.survey_file)") || exit $?
  "$bin_dir/waymark-slam" "${slam_options[@]}" "${map_options[@]}" "${part[@]}" --log "$log" --check || exit $?
}

# check_detector: sets detector_options; empty if the log has markers, or no images to find them in.
check_detector() {
  detector_options=()
  local channels
  channels=$("$bin_dir/waymark-slam" --log "$log" --print-channels) || exit $?
  grep -qx CAMERA <<<"$channels" || return 0
  ! grep -qx MARKERS <<<"$channels" || return 0
  need_programs waymark-detector
  detector_options=(--config "$robot" "${part[@]}" --log "$log")
  "$bin_dir/waymark-detector" "${detector_options[@]}" --check || exit $?
}

# clear_old_results: so that a replay that fails leaves none that look new. config.toml stays until it is
# replaced, for it may be a --config of this replay.
clear_old_results() {
  old_files=("${kRowResults[@]/#/"$folder/"}" "$folder/"{markers.lcm,{slam,markers}.lcm.part,{slam,viewer,detector}.report}
    "$logs/$row."{slam,viewer,detector}.log)
  protect_inputs "$log" "$robot" "${slam_files[@]}"
  rm -f -- "${old_files[@]}"
}

# run NAME ARGUMENTS...: one program; its words go to the log file and, being progress, to the terminal; what
# the replay took and counted to a report. One that has come to the end of a damaged log, and so has written
# one, has made what can be made of it. Should this script be killed, the kernel ends the program.
run() {
  local name=$1 program=$bin_dir/waymark-$1 log_file=$logs/$row.$1.log report=$folder/$1.report code=0
  shift
  # A pipe, for a process substitution may still be writing when the log is read.
  { setpriv --pdeathsig TERM "$program" "$@" --report "$report" 2>&1 >&3 | tee -i "$log_file" >&2; } 3>&1 || code=$?
  ((code == 0)) && return
  ((code == kExitFailed)) && [[ -f $report ]] && incomplete+=("$log_file") && return
  die "$code" "$name ended with code $code; its log is $log_file"
}

write_timings() {
  local name text=''
  for name in detector slam viewer; do
    [[ ! -f $folder/$name.report ]] || text+="${text:+,$'\n'}\"$name\": $(<"$folder/$name.report")"
  done
  put_text "$folder/timings.json" "{$text}"
  rm -f -- "$folder/"{detector,slam,viewer}.report
}

parse_arguments "$@"
prepare
show_progress_bars
put_text "$folder/config.toml" "$config"
incomplete=()
inputs=(--log "$log")
if ((${#detector_options[@]} > 0)); then
  say "the log has images, but no markers: looking for them"
  run detector "${detector_options[@]}" --out-log "$folder/markers.lcm"
  inputs+=(--log "$folder/markers.lcm")
fi
run slam "${slam_options[@]}" "${map_options[@]}" "${part[@]}" "${inputs[@]}" --out-log "$folder/slam.lcm"
run viewer "${part[@]}" --log "$log" --log "$folder/slam.lcm" --out "$folder"
[[ -f $folder/map.pgm ]] || die $kExitFailed "the log has given no map; see $logs/$row.slam.log"
write_timings
if ((${#incomplete[@]} > 0)); then
  grep -h ' error: ' "${incomplete[@]}" >&2 || true
  die $kExitFailed "$row is in $folder, but not everything went well (see above and ${incomplete[*]})"
fi
say "$row is in $folder"

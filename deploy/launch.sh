#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Runs the stack live on a scenario and supervises it: recorder, viewer, slam, detector, simulator.
#
# usage: deploy/launch.sh SCENARIO [options]
#   --out DIR         where everything goes (default: runs/SCENARIO-seedN-DATE)
#   --seed N          seed of everything random (default: the scenario's run.seed)
#   --robot FILE      what the other processes believe of the robot (default: what the scenario says)
#   --record-only     no slam and no viewer: only a log, for deploy/replay.sh
#   --no-images       leave the camera's images out of the log
#   --real-time       as fast as the clock and without lockstep, like on a real robot
#   --estimator NAME  odometry, gmapping, marker_matching or waymark (default: what waymark-slam's configuration says)
#   --config FILE     configuration of slam; may be given several times, later files win
#   --set KEY=VALUE   the same for one value; may be given several times
#   --load-map FILE   map of an earlier run (NAME.map.lcm); needs --mode
#   --mode NAME       what for: localise (it stays as it is) or extend (what is new is added)
#   --start NAME      where in it the robot is: origin (default), pose (slam.start_pose), last
#                     (needs --set slam.state_folder=DIR), anywhere
#   --save-map FILE   write the map there at the end
#   --channels FILE   section [channels], for every process: other names on the network, e.g. deploy/mbot.toml
#   --http HOST:PORT  show the run as a live page there, e.g. 127.0.0.1:8080
#   --http-token TOKEN|@FILE  whoever gives it on the page may command slam (needs --set slam.commands=true)
#   --lcm-url URL     LCM network (default: $LCM_DEFAULT_URL, else a UDP port of its own)
#
# Deletes an earlier run in the --out folder: its log, truth, robot.toml, logs/, tables, and the rows of all replays of
# it. Files that no run or replay writes stay; a folder with such names that is no run of launch.sh is refused.
# detector and viewer are restarted when they die, at most five times, and so is slam with --real-time and --start
# last; the death of simulator, slam or recorder ends the run. A signal stops everything in order, and a second one,
# 0.3 s later or more, at once. Exit codes: 0 fine, 1 the run failed, 2 bad usage or set-up, 3 a process died, 4 time-out,
# 128+n signal n.
# shellcheck source=deploy/common.sh
source "$(dirname "${BASH_SOURCE[0]}")/common.sh"

readonly kRestartDelays_us=(200000 500000 1000000 2000000 4000000)  # one per allowed restart
readonly kFinish_s=15            # after the simulator's end, for files to be written
readonly kStop_s=7               # for each process to end after SIGINT
readonly kSameRequest_us=300000  # as in signals.cpp: a terminal that closes sends SIGHUP twice
readonly kMark=logs/launch.log   # in a folder without it there is no run of ours
readonly kRunFiles=(run.lcm run.lcm.part scenario.toml robot.toml truth.tum truth_markers.csv truth_marker_moves.csv
  results.json results.md)

parse_arguments() {
  scenario='' out='' seed='' robot='' estimator='' real_time=() slam_options=() map_options=() lcm_url=${LCM_DEFAULT_URL:-}
  others=(recorder viewer slam detector) recorder_options=() slam_files=() viewer_options=() channel_options=()
  while (($# > 0)); do
    case $1 in
      --help | -h) print_usage && exit 0 ;;
      --real-time) real_time=(--real-time) && shift && continue ;;
      --record-only) others=(recorder detector) && shift && continue ;;
      --no-images) recorder_options=(--set 'recorder.exclude=["CAMERA"]') && shift && continue ;;
      --out | --seed | --robot | --estimator | --config | --set | --http | --http-token | --channels | --lcm-url | --load-map | --save-map | --mode | --start)
        need_value "$@"
        ;;&
      --out) out=$2 ;;
      --robot) need_file "$2" && robot=$2 ;;
      --seed) need_number "$1" "$2" && seed=$2 ;;
      --estimator) slam_options+=(--set "slam.estimator=$2") ;;
      --config) need_file "$2" && slam_files+=("$2") && slam_options+=(--config "$2") ;;
      --set) slam_options+=(--set "$2") ;;
      --load-map) need_file "$2" && slam_files+=("$2") && map_options+=(--load-map "$2") ;;
      --save-map) slam_files+=("$2") && map_options+=(--save-map "$2") ;;
      --mode) slam_options+=(--set "slam.mode=$2") ;;
      --start) slam_options+=(--set "slam.start=$2") ;;
      --channels) need_file "$2" && channel_options=(--config "$2") ;;
      --http) viewer_options=(--http "$2" "${viewer_options[@]}") ;;
      --http-token) viewer_options+=(--http-token "$2") ;;
      --lcm-url) lcm_url=$2 ;;
      -*) usage_error "unknown option '$1'" ;;
      *)
        [[ -z $scenario ]] || usage_error "one scenario, not both '$scenario' and '$1'"
        scenario=$1 && shift && continue
        ;;
    esac
    shift 2
  done
  [[ -n $scenario ]] || usage_error "no scenario given"
  ! is_record_only || ((${#slam_options[@]} + ${#map_options[@]} == 0)) ||
    usage_error "--record-only runs no slam: give --estimator, --config and --set to deploy/replay.sh"
  ! is_record_only || ((${#viewer_options[@]} == 0)) || usage_error "--record-only runs no viewer: leave out --http"
}

is_record_only() { ((${#others[@]} == 2)); }

# prepare: everything that can be wrong is found here, before anything runs or an old run is touched.
prepare() {
  need_file "$scenario"
  need_programs waymark-sim "${others[@]/#/waymark-}"
  checked=$(mktemp -d)  # configurations that programs have accepted
  trap 'rm -rf -- "$checked"' EXIT
  trap 'exit 130' INT  # a trap waits for the program that runs
  trap 'exit 143' TERM
  trap 'exit 129' HUP
  check_scenario
  is_record_only || check_slam
  [[ -n $lcm_url ]] || take_port
  check_programs

  local name
  name=$(basename "${scenario%.toml}")
  out=$(make_folder "${out:-runs/$name-seed$seed-$(date +%Y%m%d-%H%M%S)}")
  exec {out_lock}<"$out"
  flock --nonblock "$out_lock" || die $kExitUsage "another run is writing to '$out'"
  find_old_run
  make_folder "$out/logs" >/dev/null
  row=$(make_folder "$out/$estimator")  # the same folder without an estimator
  clear_old_run
  : >"$out/$kMark"

  put_file "$checked/robot.toml" "$out/robot.toml"
  is_record_only || make_row
  rm -rf -- "$checked"
}

check_scenario() {
  sim_options=(--config "$scenario" "${channel_options[@]}")
  ! is_record_only || sim_options+=(--set 'run.participants=["detector","recorder"]')
  [[ -z $seed ]] || sim_options+=(--seed "$seed")
  "$bin_dir/waymark-sim" "${sim_options[@]}" --dump-config >"$checked/scenario.toml" || exit $?
  "$bin_dir/waymark-sim" "${sim_options[@]}" --dump-robot-config >"$checked/robot.toml" || exit $?
  if [[ -n $robot ]]; then
    "$bin_dir/waymark-detector" --config "$robot" --dump-config >/dev/null || exit $?  # which names that file
    cp -- "$robot" "$checked/robot.toml"
  fi
  seed=$("$bin_dir/waymark-sim" "${sim_options[@]}" --print-config run.seed) || exit $?
}

check_slam() {
  slam_options=("${channel_options[@]}" --set "slam.seed=$seed" "${slam_options[@]}")
  local slam=("$bin_dir/waymark-slam" --config "$checked/robot.toml" "${slam_options[@]}")
  "${slam[@]}" --dump-config >"$checked/slam.toml" || exit $?
  estimator=$("${slam[@]}" --print-config slam.estimator) || exit $?
  slam_files+=("$("${slam[@]}" --print-config robot.markers.survey_file)") || exit $?
}

# check_programs: each takes the options that it will be started with, and can join the network. (Where
# they will write is not known yet, and none writes.)
check_programs() {
  local name command row=
  for name in sim "${others[@]}"; do
    command_of "$name" "$checked/robot.toml"
    "${command[@]}" --check || die $? "$name refuses its settings or the LCM network (see above)"
  done
}

make_row() {
  mkdir -p "$row"
  put_file "$checked/slam.toml" "$row/config.toml"
}

# find_old_run: sets old_rows, the folders of the rows of a run that is in the way, and old_files, the names
# that it, replays of its log and waymark-evaluate write. Refuses what is no run of ours.
find_old_run() {
  local there=() name folder
  old_rows=() old_files=()
  for name in "${kRunFiles[@]}"; do [[ ! -e $out/$name ]] || there+=("$name"); done
  ((${#there[@]} > 0)) || return 0
  [[ -e $out/$kMark ]] ||
    die $kExitUsage "'$out' holds ${there[*]}, but no run of launch.sh; give another folder with --out"
  old_files=("${kRunFiles[@]/#/"$out/"}" "$out/logs/"{launch,sim,slam,detector,viewer,recorder}.log)
  for folder in "$out"/*; do
    # A replay that has failed leaves no trajectory.
    [[ -f $folder/config.toml && (-f $folder/trajectory.tum || -f $out/logs/${folder##*/}.slam.log) ]] || continue
    old_rows+=("$folder")
    old_files+=("$folder/config.toml" "${kRowResults[@]/#/"$folder/"}" "$out/logs/${folder##*/}."{slam,viewer}.log)
  done
  protect_inputs "$scenario" "${robot:-$scenario}" "${slam_files[@]}" "${channel_options[@]:1}"
}

# clear_old_run: a folder holds one run; files of an earlier one must not be taken for results. What no
# run has written stays.
clear_old_run() {
  ((${#old_files[@]} > 0)) || return 0
  say "replaces the run in $out"
  rm -f -- "${old_files[@]}"
  ((${#old_rows[@]} == 0)) || rmdir --ignore-fail-on-non-empty -- "${old_rows[@]}"
}

# command_of NAME ROBOT: sets `command` to its command line.
command_of() {
  local robot=$2
  case $1 in
    recorder) command=(--out-log "$out/run.lcm" "${recorder_options[@]}" "${channel_options[@]}") ;;
    viewer) command=(--out "$row" "${viewer_options[@]}" "${channel_options[@]}") ;;
    slam) command=(--config "$robot" "${slam_options[@]}" "${map_options[@]}") ;;
    detector) command=(--config "$robot" "${channel_options[@]}") ;;
    sim) command=("${sim_options[@]}" --out "$out") ;;
  esac
  command=("$bin_dir/waymark-$1" "${command[@]}" --lcm-url "$lcm_url" "${real_time[@]}")
}

# code_of: of those that have ended. restart_us_of: when those will be started again that wait for it.
declare -A pid_of=() code_of=() restarts_of=() restart_us_of=()

# tell SENTENCE: to whoever started the script. Standard error itself is logs/launch.log during the run,
# where bash may note the ends of its jobs. The terminal may be gone.
tell() { echo "$script_name: $*" >&"$terminal" || true; }

# start NAME: in a process group of its own, so that Ctrl-C reaches only this script, which
# then stops things in order; should the script itself be killed, the kernel ends its processes.
start() {
  local name=$1 command log=$out/logs/$1.log
  command_of "$name" "$out/robot.toml"
  (
    if [[ $name == sim ]]; then  # its progress is for the terminal, too
      exec 2> >(exec tee -ipa "$log" >&"$terminal")
    else
      exec 2>>"$log"
    fi
    exec setpriv --pdeathsig TERM "${command[@]}" >>"$log" </dev/null
  ) &
  pid_of[$name]=$!
  unset "code_of[$name]" "restart_us_of[$name]"
}

is_running() { [[ -v pid_of[$1] ]] && kill -0 "${pid_of[$1]}" 2>/dev/null; }

interrupt() { ! is_running "$1" || kill -INT "${pid_of[$1]}" 2>/dev/null || true; }

# wait_for SECONDS NAME...: true when all have ended in time.
wait_for() {
  local end=$((${EPOCHREALTIME/./} + $1 * 1000000)) name
  shift
  for name in "$@"; do
    while is_running "$name"; do
      ((${EPOCHREALTIME/./} < end)) || return 1
      sleep 0.05
    done
  done
}

# stop_all: the simulator first, so that the others have seen everything that it sent.
stop_all() {
  interrupt sim
  wait_for 2 sim || true
  stop_others $kStop_s
  wait_for $kStop_s sim || true
  kill_all
}

# stop_others SECONDS: those that speak before those that listen, which hear their last words. Each has so much time.
stop_others() {
  local i
  for ((i = ${#others[@]} - 1; i >= 0; --i)); do
    interrupt "${others[i]}"
    wait_for "$1" "${others[i]}" || true
  done
}

# kill_all: also what a signal has kept from getting a name: it may come between a process's start and pid_of.
kill_all() {
  local group
  for group in $(jobs -p); do
    kill -KILL -- "-$group" 2>/dev/null || true
  done
  wait || true
}

on_signal() {
  signalled_us=${EPOCHREALTIME/./}
  # shellcheck disable=SC2064  # the number as it is now
  trap "on_next_signal $2" INT TERM HUP
  tell "stopped by SIG$1; what there is is in $out"
  stop_all
  exit $((128 + $2))
}

# on_next_signal NUMBER: somebody is impatient.
on_next_signal() {
  ((${EPOCHREALTIME/./} - signalled_us > kSameRequest_us)) || return 0
  kill_all
  exit $((128 + $1))
}

# end_run CODE SENTENCE [NAME]: stops the rest and shows the last words of the process that is to blame.
end_run() {
  tell "$2"
  if [[ -n ${3:-} && -s $out/logs/$3.log ]]; then
    tell "the end of $out/logs/$3.log:"
    tr '\r' '\n' <"$out/logs/$3.log" | tail -n 8 >&"$terminal" || true
  fi
  stop_all
  tell "logs are in $out/logs"
  exit "$1"
}

how() { if (($1 > 128)); then echo "was killed by SIG$(kill -l $(($1 - 128)))"; else echo "ended with code $1"; fi; }

# on_sim_end CODE
on_sim_end() {
  case $1 in
    0) return ;;
    "$kExitFailed" | "$kExitUsage") end_run "$1" "sim $(how "$1")" sim ;;
    "$kExitTimeout") end_run "$1" "sim gave up waiting for another process" sim ;;
    *) end_run $kExitDied "sim $(how "$1")" sim ;;
  esac
}

# can_resume: a slam that is started again goes on where it was.
can_resume() { ((${#real_time[@]} > 0)) && [[ " ${slam_options[*]} " == *" slam.start=last "* ]]; }

# on_other_end NAME CODE: restart, or end the run.
on_other_end() {
  local name=$1 code=$2 restarts=${restarts_of[$1]:-0}
  if ((code < 128)) && wait_for 1 sim; then  # the simulator's end was the cause
    local code
    take_exit_code sim
    on_sim_end "$code"
    end_run $kExitFailed "$name $(how "$2") when the run was over" "$name"
  fi
  ((code != kExitUsage)) || end_run $kExitUsage "$name could not be set up" "$name"
  case $name in
    detector | viewer | slam)
      [[ $name != slam ]] || can_resume || end_run $kExitDied "$name $(how "$code")" "$name"
      ((restarts < ${#kRestartDelays_us[@]})) ||
        end_run $kExitDied "$name $(how "$code") for the $((restarts + 1))th time" "$name"
      tell "$name $(how "$code"); starting it again"
      restart_us_of[$name]=$((${EPOCHREALTIME/./} + kRestartDelays_us[restarts]))
      restarts_of[$name]=$((restarts + 1))
      ;;
    *) end_run $kExitDied "$name $(how "$code")" "$name" ;;
  esac
}

# is_death CODE: in lockstep all but the simulator end by themselves once it has said that the run is over.
is_death() { (($1 != 0 || ${#real_time[@]} > 0)); }

# take_exit_code NAME: sets `code`; false while the process runs and when the code was taken already.
take_exit_code() {
  [[ ! -v code_of[$1] ]] && ! is_running "$1" || return 1
  code=0
  wait "${pid_of[$1]}" || code=$?
  code_of[$1]=$code
}

# supervise: returns when the simulator has come to its good end. (Not with wait -n: in bash 5.2 it
# misses one of two processes that die together.)
supervise() {
  local name code
  until take_exit_code sim; do
    for name in "${others[@]}"; do
      ! take_exit_code "$name" || ! is_death "$code" || on_other_end "$name" "$code"
      [[ ! -v restart_us_of[$name] ]] || ((${EPOCHREALTIME/./} < restart_us_of[$name])) || start "$name"
    done
    sleep 0.1 || true  # a signal may end it, too
  done
  on_sim_end "$code"
}

# finish: the others end by themselves in lockstep. In real time they are told to.
finish() {
  local name code
  ((${#real_time[@]} == 0)) || stop_others $kFinish_s
  wait_for $kFinish_s "${others[@]}" ||
    end_run $kExitFailed "not all processes ended within $kFinish_s s of the simulator"
  for name in "${others[@]}"; do
    ! take_exit_code "$name" || ((code == 0)) ||
      end_run $kExitFailed "$name $(how "$code") when the run was over" "$name"
  done
  [[ ! -v restart_us_of[slam] ]] || end_run $kExitDied "the run was over before slam was started again" slam
  ((${restarts_of[viewer]:-0} == 0)) || render_from_log
}

# render_from_log: a viewer that came in late has not seen everything; the log has.
render_from_log() {
  tell "the viewer was restarted: its files are made once more, from the log"
  "$bin_dir/waymark-viewer" --log "$out/run.lcm" --out "$row" 2>>"$out/logs/viewer.log" ||
    end_run $kExitFailed "viewer $(how $?) on the log" viewer
}

parse_arguments "$@"
prepare
set -m
trap kill_all EXIT
trap '' PIPE  # whoever reads what this script says may be gone first
trap 'on_signal INT 2' INT
trap 'on_signal TERM 15' TERM
trap 'on_signal HUP 1' HUP
show_progress_bars
exec {terminal}>&2 2>>"$out/logs/launch.log"
tell "$(basename "$scenario"), seed $seed, ${estimator:-no estimator}, into $out"
for name in "${others[@]}" sim; do start "$name"; done
((${#viewer_options[@]} == 0)) || tell "the live page is http://${viewer_options[1]}/"
supervise
finish
tell "finished in $SECONDS s; results are in $row, logs in $out/logs"

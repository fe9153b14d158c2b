#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The scripts of deploy/ with fake programs: what they check, pass on, supervise and leave behind.
#
# usage: tests/process/scripts_test.sh [--list | CASE...]
# shellcheck disable=SC2317  # cases are called by name
# shellcheck source=tests/process/fake_stack.sh
source "$(dirname "${BASH_SOURCE[0]}")/fake_stack.sh"

# ------------------------------------------------------------------------------ bad input

bad_usage() {
  expect 2 launch.sh && expect_output "no scenario given"
  expect 2 launch.sh a.toml b.toml && expect_output "one scenario"
  expect 2 launch.sh "$scenario" --bogus && expect_output "unknown option '--bogus'"
  expect 2 launch.sh "$scenario" --seed && expect_output "seed needs a value"
  expect 2 launch.sh "$scenario" --seed seven && expect_output "whole number, not 'seven'"
  expect 2 launch.sh "$work/nowhere.toml" && expect_output "no readable file '.*nowhere.toml'"
  expect 2 launch.sh "$scenario" --estimator unknown --out "$out" && expect_output "got 'unknown'"
  expect 2 launch.sh "$scenario" --record-only --estimator odometry && expect_output "record-only runs no slam"
  expect 2 replay.sh && expect_output "no log given"
  expect 2 replay.sh "$work/run.lcm" --estimator odometry && expect_output "no readable file"
  expect 2 demo.sh --scenario "$work/nowhere.toml" && expect_output "no readable file"
  expect 2 demo.sh --bogus && expect_output "unknown option"
  expect 2 real_logs.sh && expect_output "out is missing"
  expect 2 real_logs.sh --out "$out" --import fr079 && expect_output "import needs NAME:OPTIONS, not 'fr079'"
  expect 2 real_logs.sh --out "$out" --seeds 3-1 && expect_output "goes backwards"
  expect 2 install-deps.sh --bogus && expect_output "unknown option"
  expect 0 launch.sh --help && expect_output "usage: deploy/launch.sh SCENARIO"
}

# In a tree in which nothing can be installed, should they try.
test_scripts_explain_themselves() {
  local tree=$work/tree script option
  mkdir -p "$tree"/{tests,.ci}
  touch "$tree/CMakeLists.txt"
  cp -r "$source_dir/deploy" "$tree/deploy"
  cp "$source_dir/tests/run.sh" "$tree/tests/run.sh"
  cp "$source_dir/.ci/run" "$tree/.ci/run"
  printf '#!/bin/sh\necho "it began"; exit 1\n' >"$tree/deploy/install-deps.sh"
  for script in tests/run.sh .ci/run; do
    for option in --help -h; do
      expect 0 "../../../tree/$script" $option && expect_output "^usage: $script"
    done
    for option in --bogus again ''; do
      expect 2 "../../../tree/$script" "$option" && expect_output "unknown argument '$option'; .*see ${script##*/} --help"
    done
    expect 1 "../../../tree/$script" && expect_output "it began"
  done
}

bad_out_folder() {
  touch "$work/file"
  expect 2 launch.sh "$scenario" --out "$work/file/run" && expect_output "cannot make the folder"
  expect 2 launch.sh "$scenario" --out /proc/run && expect_output "cannot make the folder"
  expect 2 demo.sh --out /proc/run --scenario "$scenario" && expect_output "cannot make the folder"
}

missing_program() {
  rm "$work/bin/waymark-viewer"
  expect 2 launch.sh "$scenario" --out "$out"
  expect_output "no program .*waymark-viewer; build with"
}

# Nothing to install: no apt, no network, and quickly.
install_deps_when_nothing_is_missing() {
  mkdir "$work/path"
  printf '#!/bin/sh\necho "apt-get was called" >&2; exit 1\n' >"$work/path/apt-get"
  # shellcheck disable=SC2016  # for the fake to expand
  printf '#!/bin/sh\nshift 2; for name; do echo "$name installed"; done\n' >"$work/path/dpkg-query"
  chmod +x "$work"/path/*
  PATH=$work/path:$PATH expect 0 install-deps.sh
  [[ ! -s $output ]] || fail "it should have been silent"
}

install_deps_says_what_fails() {
  mkdir "$work/path"
  printf '#!/bin/sh\necho "E: no network"; exit 100\n' >"$work/path/apt-get"
  printf '#!/bin/sh\nexec "$@"\n' >"$work/path/sudo"
  printf '#!/bin/sh\necho "ninja-build not-installed"; exit 1\n' >"$work/path/dpkg-query"
  chmod +x "$work"/path/*
  PATH=$work/path:$PATH expect 2 install-deps.sh
  expect_output "E: no network" && expect_output "'apt-get update' failed"
  expect_output "installing cmake .*liblcm-dev"
}

# ------------------------------------------------------------------------------ a good run

good_run() {
  expect 0 launch.sh "$scenario" --out "$out" --seed 3 --set slam.particles=9
  expect_nothing_left
  expect_output "finished in"
  grep -q -- "--config $scenario --seed 3 --out $out --lcm-url udpm" "$work/sim.arguments" || fail "sim"
  grep -q -- "--config $out/robot.toml --set slam.seed=7 --set slam.particles=9" "$work/slam.arguments" || fail "slam"
  grep -q -- "--out-log $out/run.lcm" "$work/recorder.arguments" || fail "recorder"
  grep -q -- "--out $out/fake_estimator" "$work/viewer.arguments" || fail "viewer"
  for name in sim slam detector viewer recorder; do
    grep -q "$name says something" "$out/logs/$name.log" || fail "$name.log"
  done
}

own_folder_by_default() {
  cd "$work"
  expect 0 launch.sh "$scenario"
  compgen -G "$work/runs/short-seed7-*/robot.toml" >/dev/null || fail "no folder of its own"
}

# leftovers_of_case: what an earlier run and a replay have left in $out, and two folders of its owner.
leftovers_of_case() {
  mkdir -p "$out"/{logs,old_row,failed_row,notes,settings}
  touch "$out/failed_row/config.toml" "$out/logs/failed_row.slam.log"
  touch "$out"/{run.lcm,robot.toml,results.json,truth_marker_moves.csv} "$out"/logs/{launch,sim,old_row.slam}.log
  touch "$out"/old_row/{config.toml,trajectory.tum,map.png} "$out/notes/today" "$out/settings/config.toml"
  touch "$out/logs/notes"
}

expect_intact_of_case() {
  [[ -e $out/run.lcm && -e $out/old_row/map.png && -e $out/logs/sim.log ]] || fail "the old run is gone"
}

an_old_run_is_replaced() {
  leftovers_of_case
  expect 0 launch.sh "$scenario" --out "$out"
  expect_output "replaces the run in $out"
  local file
  for file in results.json truth_marker_moves.csv {old,failed}_row logs/{old,failed}_row.slam.log; do
    [[ ! -e $out/$file ]] || fail "the old $file is left"
  done
  for file in notes/today settings/config.toml logs/notes; do
    [[ -e $out/$file ]] || fail "somebody's $file is gone"
  done
  touch "$out/fake_estimator/trajectory.tum" "$out/fake_estimator/notes"
  expect 0 launch.sh "$scenario" --out "$out" --estimator other
  [[ -e $out/fake_estimator/notes && ! -e $out/fake_estimator/config.toml ]] || fail "fake_estimator"
}

what_is_no_run_is_not_replaced() {
  mkdir -p "$out"/{logs,mine}
  touch "$out"/{robot.toml,logs/notes,mine/config.toml}
  expect 2 launch.sh "$scenario" --out "$out"
  expect_output "'$out' holds robot.toml, but no run of launch.sh; give another folder"
  [[ -e $out/robot.toml && -e $out/logs/notes && -e $out/mine/config.toml ]] || fail "somebody's files are gone"
}

an_old_run_stays_when_the_new_one_cannot_start() {
  leftovers_of_case
  cp "$scenario" "$out/scenario.toml"
  expect 2 launch.sh "$out/scenario.toml" --out "$out" --estimator unknown && expect_output "got 'unknown'"
  expect 2 launch.sh "$out/scenario.toml" --out "$out" && expect_output "scenario.toml' belongs to the run"
  local option
  for option in "--load-map " "--save-map " "--set robot.markers.survey_file="; do
    # shellcheck disable=SC2086  # two words
    expect 2 launch.sh "$scenario" --out "$out" $option"$out/old_row/map.png" && expect_output "map.png' belongs to the run"
  done
  expect_intact_of_case
}

an_old_run_stays_when_a_program_refuses() {
  leftovers_of_case
  FAKE_sim_refuses="--config $scenario" expect 2 launch.sh "$scenario" --out "$out"
  expect_output "sim refuses its settings or the LCM network" && expect_intact_of_case
  FAKE_detector_refuses="--config /" expect 2 launch.sh "$scenario" --out "$out"
  expect_output "detector refuses its settings" && expect_intact_of_case
  FAKE_slam_refuses="--set slam.a=1" expect 2 launch.sh "$scenario" --out "$out" --set slam.a=1
  expect_output "slam refuses its settings" && expect_intact_of_case
  FAKE_viewer_refuses="--real-time" expect 2 launch.sh "$scenario" --out "$out" --real-time
  expect_output "viewer refuses its settings" && expect_intact_of_case
  FAKE_recorder_refuses="--lcm-url nonsense://" expect 2 launch.sh "$scenario" --out "$out" --record-only --lcm-url nonsense://
  expect_output "recorder refuses its settings" && expect_intact_of_case
  [[ ! -e $work/pids ]] || fail "something ran"
}

an_old_run_stays_when_there_is_no_place_for_the_new_one() {
  leftovers_of_case
  touch "$out/fake_estimator"
  expect 2 launch.sh "$scenario" --out "$out" && expect_output "cannot make the folder '$out/fake_estimator'"
  expect_intact_of_case
}

# The second one's end ends the first.
two_stacks_have_two_ports() {
  FAKE_sim_seconds=300 "$deploy/launch.sh" "$scenario" --out "$work/other" >"$work/other_output" 2>&1 &
  wait_until all_started
  sed -E 's/.*--lcm-url ([^ ]+).*/\1/' "$work/sim.arguments" >"$work/other_url"
  expect 0 launch.sh "$scenario" --out "$out"
  wait $! || fail "the other stack failed"
  ! grep -qF -- "$(cat "$work/other_url")" "$work/sim.arguments" || fail "both use $(cat "$work/other_url")"
}

# On a machine that is new: the folder of the locks was not there a moment ago. The fake mkdir finds that another stack
# was faster.
two_stacks_make_the_folder_of_ports_at_once() {
  local make="source '$deploy/common.sh'; make_shared_folder"
  mkdir "$work/path"
  # shellcheck disable=SC2016  # for the fake to expand
  printf '#!/bin/sh\n%s "$@"; exec %s "$@"\n' "$(command -v mkdir)" "$(command -v mkdir)" >"$work/path/mkdir"
  chmod +x "$work/path/mkdir"
  PATH=$work/path:$PATH bash -c "$make '$work/ports'" >"$output" 2>&1 || fail "the slower one failed"
  ! bash -c "$make '$work/nowhere/ports'" >"$output" 2>&1 || fail "this cannot be made"
  expect_output "cannot make the folder '$work/nowhere/ports'"
}

one_folder_for_one_run() {
  FAKE_sim_seconds=300 "$deploy/launch.sh" "$scenario" --out "$out" >/dev/null 2>&1 &
  wait_until all_started
  expect 2 launch.sh "$scenario" --out "$out" && expect_output "another run is writing"
  touch "$work/closed"
  wait $! || fail "the first one failed"
}

given_url_is_used() {
  expect 0 launch.sh "$scenario" --out "$out" --lcm-url memq://
  grep -q -- "--lcm-url memq://" "$work/slam.arguments" || fail "--lcm-url is not passed on"
  LCM_DEFAULT_URL=udpm://239.255.76.67:7999 expect 0 launch.sh "$scenario" --out "$out"
  grep -q -- "--lcm-url udpm://239.255.76.67:7999" "$work/slam.arguments" || fail "LCM_DEFAULT_URL"
}

real_time_processes_are_interrupted() {
  FAKE_sim_waits_for=5 expect 0 launch.sh "$scenario" --out "$out" --real-time  # no signal before its trap is set
  [[ $(wc -l <"$work/interrupted") == 4 ]] || fail "not all four were interrupted"
  grep -q -- "--real-time" "$work/detector.arguments" || fail "--real-time is not passed on"
}

# ------------------------------------------------------------------------------ processes that end

critical_process_dies() {
  local name
  for name in sim slam recorder; do
    rm -f "$work"/pids* "$work/closed"
    FAKE_sim_seconds=30 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
    wait_until all_started
    kill -KILL "$(cat "$work/pids.$name")"
    local code=0
    wait $! || code=$?
    ((code == 3)) || fail "exit code $code when $name died"
    expect_output "^launch: $name was killed by SIGKILL"
    expect_output "^$name says something"
    expect_nothing_left
  done
}

detector_and_viewer_are_restarted() {
  FAKE_sim_seconds=2 "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
  wait_until all_started
  kill -KILL "$(cat "$work/pids.detector")" "$(cat "$work/pids.viewer")"
  wait $! || fail "exit code $?"
  expect_output "detector was killed by SIGKILL; starting it again"
  [[ $(wc -l <"$work/pids.detector") == 2 ]] || fail "detector was not restarted once"
  grep -q -- "--log $out/run.lcm --out $out/fake_estimator" "$work/viewer.replay" || fail "no pictures from the log"
}

# What ends by itself, or well because it was told to, is missing all the same.
a_process_that_is_told_to_end_in_real_time_is_missing() {
  FAKE_sim_seconds=30 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" --real-time >"$output" 2>&1 &
  local run=$! code=0
  wait_until all_started
  kill -TERM "$(cat "$work/pids.viewer")"
  wait_until grep -q "viewer ended with code 0; starting it again" "$output"
  kill -TERM "$(cat "$work/pids.recorder")"
  wait $run || code=$?
  ((code == 3)) || fail "exit code $code"
  expect_output "recorder ended with code 0"
  expect_nothing_left
}

# Dead for the fourth time, the viewer would be started again two seconds after that.
a_run_that_ends_before_a_restart_is_good() {
  local began=$SECONDS
  FAKE_sim_seconds=3 FAKE_viewer_exit=crash expect 0 launch.sh "$scenario" --out "$out" --real-time
  ((SECONDS - began < 12)) || fail "it took $((SECONDS - began)) s"
  expect_output "its files are made once more, from the log"
  rm "$work/closed"
  FAKE_sim_seconds=3 FAKE_slam_exit=crash expect 3 launch.sh "$scenario" --out "$out" --real-time --start last
  expect_output "the run was over before slam was started again"
}

restarts_end() {
  FAKE_sim_seconds=60 FAKE_detector_exit=crash expect 3 launch.sh "$scenario" --out "$out"
  [[ $(wc -l <"$work/pids.detector") == 6 ]] || fail "not five restarts"
  expect_nothing_left
}

exit_codes_are_passed_on() {
  FAKE_sim_exit=4 expect 4 launch.sh "$scenario" --out "$out" && expect_output "gave up waiting"
  FAKE_sim_exit=1 expect 1 launch.sh "$scenario" --out "$out"
  FAKE_sim_exit=2 expect 2 launch.sh "$scenario" --out "$out"
  FAKE_slam_exit=2 FAKE_sim_seconds=30 expect 2 launch.sh "$scenario" --out "$out"
  expect_output "slam could not be set up"
  FAKE_slam_exit=1 FAKE_sim_seconds=30 expect 3 launch.sh "$scenario" --out "$out"
  expect_output "slam ended with code 1"
  expect_nothing_left
}

signals_stop_everything() {
  local signal
  for signal in INT:130 TERM:143 HUP:129; do
    rm -f "$work"/pids* "$work/closed" "$work/interrupted"
    # By way of env: bash starts background jobs with SIGINT ignored.
    FAKE_sim_seconds=30 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
    wait_until all_started
    kill "-${signal%:*}" $!
    local code=0
    wait $! || code=$?
    ((code == ${signal#*:})) || fail "exit code $code after SIG${signal%:*}"
    [[ $(xargs <"$work/interrupted") == "sim detector slam viewer recorder" ]] || fail "not in order"
    expect_nothing_left
  done
}

# What is said cannot be written any more, and SIGHUP comes from the terminal and from the shell in it.
a_terminal_that_closes_stops_everything_in_order() {
  local run code=0
  FAKE_sim_seconds=30 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" --real-time >/dev/full 2>&1 &
  run=$!
  wait_until all_started
  kill -HUP $run
  sleep 0.1
  kill -HUP $run || true
  wait $run || code=$?
  ((code == 129)) || fail "exit code $code"
  [[ $(xargs <"$work/interrupted") == "sim detector slam viewer recorder" ]] || fail "not in order"
  expect_nothing_left
}

# As in: launch.sh ... | head
a_reader_that_goes_first_does_not_end_the_run() {
  exec 8> >(exec sleep 0.5)
  FAKE_sim_seconds=1.5 "$deploy/launch.sh" "$scenario" --out "$out" >&8 2>&8 || fail "exit code $?"
  [[ -e $out/run.lcm ]] || fail "no log"
}

a_signal_while_settings_are_checked_leaves_nothing() {
  local signal code
  for signal in INT:130 TERM:143 HUP:129; do
    rm -f "$work/pids"
    FAKE_slam_thinks=1 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
    wait_until test -e "$work/pids"
    kill "-${signal%:*}" $!
    code=0
    wait $! || code=$?
    ((code == ${signal#*:})) || fail "exit code $code after SIG${signal%:*}"
    expect_nothing_left
  done
}

killed_replay_leaves_nothing() {
  touch "$work/run.lcm" "$work/robot.toml"
  FAKE_slam_replays=90 "$deploy/replay.sh" "$work/run.lcm" --estimator odometry >"$output" 2>&1 &
  wait_until test -e "$work/pids"
  kill -TERM $!
  wait $! || true
  wait_until nothing_left
}

# A process that stays would take 7 s to be killed.
a_second_signal_ends_it_at_once() {
  FAKE_viewer_stays=1 FAKE_sim_seconds=30 env --default-signal=INT "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
  local run=$! code=0 began
  wait_until all_started
  kill -TERM $run
  wait_until test -e "$work/interrupted"
  sleep 0.4  # sooner it would count as the same one
  began=$SECONDS
  kill -TERM $run
  wait $run || code=$?
  ((code == 143 && SECONDS - began <= 3)) || fail "exit code $code after $((SECONDS - began)) s"
  expect_nothing_left
}

# Even when the script itself has no chance to clean up.
killed_script_leaves_nothing() {
  FAKE_sim_seconds=30 "$deploy/launch.sh" "$scenario" --out "$out" >"$output" 2>&1 &
  wait_until all_started
  kill -KILL $!
  wait $! 2>/dev/null || true
  wait_until nothing_left
}

stubborn_process_is_killed() {
  FAKE_viewer_stays=1 expect 1 launch.sh "$scenario" --out "$out"
  expect_output "not all processes ended"
  expect_nothing_left
}

run_cases "$@"

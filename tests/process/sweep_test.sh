#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The machinery of a sweep with fake programs: what is planned, done, done again, failed, killed, and what
# happens on a full disk. (With real programs: stack_test.sh.)
#
# usage: tests/process/sweep_test.sh [--list | CASE...]
# shellcheck disable=SC2317  # cases are called by name
# shellcheck source=tests/process/fake_stack.sh
source "$(dirname "${BASH_SOURCE[0]}")/fake_stack.sh"

sweep=$work/sweep
arguments=(sweep.sh "$scenario" --seeds 1-2 --estimators "odometry,mine=waymark:slam.a=1" --out "$sweep" --jobs 1)

# evaluations_of_case: how often a run folder was evaluated so far.
evaluations_of_case() { grep -c '^run ' "$work/evaluate.calls"; }

no_script_left_of_case() { ! pgrep -f -- "$deploy/" >/dev/null; }

# path_of_case: a folder in front of PATH for fakes of the system's programs.
path_of_case() {
  mkdir -p "$work/path"
  PATH=$work/path:$PATH
}

bad_usage() {
  expect 2 sweep.sh && expect_output "no scenario given"
  expect 2 sweep.sh "$scenario" && expect_output "--out is missing"
  expect 2 sweep.sh "$scenario" --out "$sweep" --seeds one && expect_output "needs a list like 1-20"
  expect 2 sweep.sh "$scenario" --out "$sweep" --jobs 0 && expect_output "whole number above 0, not '0'"
  expect 2 sweep.sh "$work/nowhere.toml" --out "$sweep" && expect_output "no readable file '.*nowhere.toml'"
  expect 2 sweep.sh "$scenario" --out "$sweep" --estimators unknown && expect_output "got 'unknown'"
  expect 2 sweep.sh "$scenario" "$scenario" --out "$sweep" && expect_output "two scenarios are called 'short'"
  expect 2 sweep_job.sh "$sweep" short 1
  expect 0 "${arguments[@]}" --plan-only
  expect 2 sweep_job.sh "$sweep" short 3 && expect_output "no job 'short 3'"
  expect 0 sweep.sh --help && expect_output "usage: deploy/sweep.sh SCENARIO"
}

seeds_that_cannot_be() {
  local seeds
  for seeds in 5-2:"'5-2' goes backwards" 1,3-1:"'3-1' goes backwards" 1,2,1:"1 is there twice" 1-4,03:"3 is there twice" \
    1234567890123456:"at most 15 digits" 1-12345678901234567890:"at most 15 digits" 1-999999999:"more than 100000" \
    1--2:"a list like" -1:"a list like" 1.5:"a list like" ',:a list like' ':no seed in'; do
    expect 2 sweep.sh "$scenario" --out "$sweep" --seeds "${seeds%%:*}" && expect_output "${seeds#*:}"
  done
  [[ ! -e $sweep ]] || fail "something was written"
  expect 0 sweep.sh "$scenario" --out "$sweep" --seeds 007,08-9,123456789012345 --plan-only
  [[ $(cut -d ' ' -f 2 "$sweep/plan/jobs" | tr '\n' ' ') == "7 8 9 123456789012345 " ]] || fail "jobs"
}

rows_that_cannot_be() {
  local name
  for name in ../run a/b . .. a.b -x "a'b" logs failed recorded finished "$(printf 'x%.0s' {1..101})"; do
    expect 2 sweep.sh "$scenario" --out "$sweep" --estimators "odometry,$name=waymark"
    expect_output "'$name' is no name for a row"
  done
  expect 2 sweep.sh "$scenario" --out "$sweep" --estimators odometry,waymark,odometry
  expect_output "two rows are called 'odometry'"
  expect 2 sweep.sh "$scenario" --out "$sweep" --estimators a=waymark,a=odometry
  expect_output "two rows are called 'a'"
  expect 2 sweep.sh "$scenario" --out "$sweep" --estimators '' && expect_output "no row in --estimators"
  [[ ! -e $sweep ]] || fail "something was written"
}

scenarios_that_cannot_be() {
  local name
  for name in plan plots plan.new .hidden -x 'a b'; do
    touch "$work/$name.toml"
    expect 2 sweep.sh "$work/$name.toml" --out "$sweep" && expect_output "'$name': "
  done
  [[ ! -e $sweep ]] || fail "something was written"
}

# plan_of_case: all that the sweep's plan says.
plan_of_case() { (cd "$sweep/plan" && find . -type f | sort | xargs tail -n +1); }

an_earlier_plan_survives_a_call_that_comes_to_nothing() {
  expect 0 "${arguments[@]}" --plan-only
  local plan other
  plan=$(plan_of_case)
  cp "$scenario" "$work/other.toml"
  other=(sweep.sh "$scenario" "$work/other.toml" --seeds 5 --estimators waymark --out "$sweep" --jobs 1)
  expect 2 "${other[@]}" --estimators unknown
  [[ $(plan_of_case) == "$plan" ]] || fail "the plan is another after a wrong estimator"
  FAKE_sim_fails=other.toml expect 1 "${other[@]}"
  [[ $(plan_of_case) == "$plan" && ! -e $sweep/plan.new ]] || fail "the plan is another after a wrong scenario"
  touch "$work/faults.toml"
  FAKE_faults_fails=--list expect 1 "${other[@]}" --variants "$work/faults.toml"
  [[ $(plan_of_case) == "$plan" && ! -e $sweep/plan.new ]] || fail "the plan is another after wrong variants"
  WAYMARK_MIN_FREE_MB=999999999 expect 2 "${other[@]}" && expect_output "the disk of $sweep is full"
  [[ $(plan_of_case) == "$plan" && ! -e $sweep/plan.new ]] || fail "the plan is another after a lack of disk"
  FAKE_sim_kills=other.toml expect 137 "${other[@]}"
  [[ $(plan_of_case) == "$plan" && -e $sweep/plan.new ]] || fail "the plan is another after SIGKILL"
  mv "$sweep/plan" "$sweep/plan.old"  # killed between the two
  FAKE_sim_fails=other.toml expect 1 "${other[@]}"
  [[ $(plan_of_case) == "$plan" ]] || fail "the plan did not come back"
  expect 0 "${other[@]}" --plan-only
  [[ $(cat "$sweep/plan/jobs") == $'short 5\nother 5' ]] || fail "no new plan"
  [[ ! -e $sweep/plan.new && ! -e $sweep/plan.old ]] || fail "leftovers"
}

a_folder_of_somebody_is_no_plan() {
  mkdir -p "$sweep/plan"
  touch "$sweep/plan/notes"
  expect 2 "${arguments[@]}" && expect_output "'$sweep/plan' is no plan of a sweep"
  [[ -e $sweep/plan/notes ]] || fail "somebody's notes are gone"
}

the_size_is_stated_and_the_plan_is_written() {
  expect 0 "${arguments[@]}" --plan-only
  expect_output "1 scenarios x 2 seeds = 2 logs, 4 runs of an estimator, 1 at a time"
  [[ $(cat "$sweep/plan/jobs") == $'short 1\nshort 2' ]] || fail "jobs"
  [[ $(cat "$sweep/plan/rows") == $'odometry odometry\nmine waymark slam.a=1' ]] || fail "rows"
  [[ $(cut -f 1-4 "$sweep/plan/runs.tsv" | tail -n 1) == $'short\t2\tshort/seed-2\tmine' ]] || fail "runs.tsv"
  [[ ! -e $work/pids ]] || fail "something ran"
}

every_job_is_done_once() {
  expect 0 "${arguments[@]}"
  [[ -e $sweep/short/seed-2/mine/done && -e $sweep/short/seed-1/odometry/done ]] || fail "not all were done"
  grep -q -- "--set slam.estimator=waymark --set slam.a=1 --log $sweep/short/seed-2/run.lcm" "$work/slam.replay" || fail "slam"
  grep -q -- 'exclude=\["CAMERA"\]' "$work/recorder.arguments" || fail "images are recorded"
  grep -q -- 'participants=\["detector","recorder"\] --seed 2' "$work/sim.arguments" || fail "sim"
  expect_output "2 of 2 jobs done"
  [[ $(evaluations_of_case) == 2 ]] || fail "evaluations"
  expect 0 "${arguments[@]}"
  [[ $(evaluations_of_case) == 2 ]] || fail "jobs were done twice"
  expect_nothing_left
}

a_new_row_or_seed_uses_the_logs_that_are_there() {
  expect 0 "${arguments[@]}"
  local logs
  logs=$(wc -l <"$work/pids.recorder")
  expect 0 sweep.sh "$scenario" --seeds 1-3 --estimators odometry,other=waymark --out "$sweep"
  [[ $(wc -l <"$work/pids.recorder") == $((logs + 1)) ]] || fail "logs were recorded twice"
  [[ -e $sweep/short/seed-1/other/done && -e $sweep/short/seed-3/odometry/done ]] || fail "not all were done"
}

another_scenario_of_the_same_name_is_recorded_anew() {
  expect 0 "${arguments[@]}"
  echo "[world]" >>"$scenario"
  expect 0 "${arguments[@]}"
  [[ $(wc -l <"$work/pids.recorder") == 4 ]] || fail "old logs were taken"
}

another_expectation_is_only_evaluated_anew() {
  expect 0 "${arguments[@]}"
  printf '[expect]\nate_origin_m = 0.5\n' >>"$scenario"
  expect 0 "${arguments[@]}"
  [[ $(wc -l <"$work/pids.recorder") == 2 ]] || fail "logs were recorded twice"
  [[ $(evaluations_of_case) == 4 ]] || fail "not evaluated anew"
  grep -q '^ate_origin_m = 0.5' "$sweep/short/seed-2/expect.toml" || fail "expect.toml"
}

a_failed_replay_is_a_failure_of_its_row() {
  FAKE_slam_fails="seed-1/run.lcm --out-log $sweep/short/seed-1/mine" expect 0 "${arguments[@]}"
  grep -q "replay ended with code 1; logs are $sweep/short/seed-1/logs/mine" "$sweep/short/seed-1/mine/failed" || fail "mine/failed"
  [[ -e $sweep/short/seed-1/odometry/done && -e $sweep/short/seed-2/mine/done ]] || fail "it stopped the others"
  expect_output "seed 1: replay ended with code 1"
  expect 0 sweep_job.sh "$sweep" short 1 --again
  [[ -e $sweep/short/seed-1/mine/done && ! -e $sweep/short/seed-1/mine/failed ]] || fail "--again did not help"
  tail -n 1 "$work/evaluate.calls" | grep -q "^sweep $sweep" || fail "the table was not made anew"
}

a_failed_recording_is_a_failure_of_its_seed() {
  FAKE_sim_fails="--seed 1 " expect 0 "${arguments[@]}"
  grep -q "recording ended with code 1; logs are in $sweep/short/seed-1/logs" "$sweep/short/seed-1/failed" || fail "failed"
  [[ -e $sweep/short/seed-2/mine/done ]] || fail "it stopped the others"
  expect 0 "${arguments[@]}"
  [[ -e $sweep/short/seed-1/mine/done && ! -e $sweep/short/seed-1/failed ]] || fail "it was not tried again"
}

# The reader of its output goes first.
a_killed_sweep_goes_on() {
  expect 0 "${arguments[@]}" --plan-only
  expect 0 sweep_job.sh "$sweep" short 1
  local signal
  for signal in TERM:143 KILL:137; do
    rm -f "$work"/pids* "$work/closed"
    FAKE_sim_seconds=30 "$deploy/${arguments[0]}" "${arguments[@]:1}" > >(exec head -n 1 >"$output") 2>&1 &
    local script=$!
    wait_until grep -qs . "$work/pids.sim"  # the last one to be started
    if [[ $signal == KILL* ]]; then kill -STOP $script && pkill -KILL -P $script; fi  # parallel first
    kill "-${signal%:*}" $script 2>/dev/null || true
    local code=0
    wait $script || code=$?
    ((code == ${signal#*:})) || fail "exit code $code after SIG${signal%:*}"
    [[ $signal == KILL* ]] && break
    wait_until nothing_left
    [[ ! -e $sweep/short/seed-2/finished ]] || fail "seed 2 counts as done"
  done
  touch "$work/closed"  # ends the programs and scripts that SIGKILL has left behind
  wait_until no_script_left_of_case
  expect 0 "${arguments[@]}"
  [[ -e $sweep/short/seed-2/mine/done ]] || fail "seed 2 was not done"
  [[ $(evaluations_of_case) == 2 ]] || fail "seed 1 was done twice"
}

a_full_disk_stops_everything() {
  expect 0 "${arguments[@]}" --plan-only
  path_of_case
  printf '#!/bin/sh\necho Avail\necho 150M\n' >"$work/path/df"
  chmod +x "$work/path/df"
  expect 2 "${arguments[@]}" && expect_output "the disk of $sweep is full: 150 MB are free"
  expect 1 sweep_job.sh "$sweep" short 1 && expect_output "the disk of $sweep is full: 150 MB are free; make room"
  [[ ! -e $work/pids ]] || fail "something ran"
  # The disk fills up during the second job.
  printf '#!/bin/sh\necho Avail\n[ -e %s ] && echo 150M || echo 999999M\n' "$sweep/short/seed-1/finished" >"$work/path/df"
  expect 1 "${arguments[@]}" && expect_output "is full" && expect_output "stopped before the end"
  [[ -e $sweep/short/seed-1/mine/done && ! -e $sweep/short/seed-2 ]] || fail "not stopped between the jobs"
  rm "$work/path/df"
  expect 0 "${arguments[@]}"
  [[ -e $sweep/short/seed-2/mine/done ]] || fail "it did not go on"
}

variants_are_rows_of_the_same_log() {
  touch "$work/faults.toml"
  expect 0 "${arguments[@]}" --variants "$work/faults.toml"
  [[ $(wc -l <"$work/pids.recorder") == 2 ]] || fail "not one log per seed"
  [[ -e $sweep/short+wrong_ids/seed-2/mine/done ]] || fail "the variant was not done"
  [[ ! -e $sweep/short+wrong_ids/seed-2/run.lcm && -e $sweep/short/seed-2/run.lcm ]] || fail "logs"
  grep -q $'^short+wrong_ids\t1\tshort+wrong_ids/seed-1\tmine\t' "$sweep/plan/runs.tsv" || fail "runs.tsv"
  expect 0 "${arguments[@]}" --variants "$work/faults.toml"
  [[ $(evaluations_of_case) == 4 ]] || fail "variants were done twice"
}

a_job_that_is_being_done_is_left_alone() {
  expect 0 "${arguments[@]}" --plan-only
  FAKE_sim_seconds=300 "$deploy/sweep_job.sh" "$sweep" short 1 >/dev/null 2>&1 &
  wait_until grep -qs . "$work/pids.sim"
  expect 0 sweep_job.sh "$sweep" short 1 && expect_output "is being done by somebody else"
  expect 2 sweep_job.sh "$sweep" short 1 --again && expect_output "is being done by somebody else; wait for that"
  [[ -e $sweep/short/seed-1/robot.toml ]] || fail "its files are gone"
  touch "$work/closed"
  wait $! || fail "the first one failed"
  [[ -e $sweep/short/seed-1/mine/done ]] || fail "it was not done"
}

one_sweep_for_one_folder() {
  FAKE_sim_seconds=300 "$deploy/${arguments[0]}" "${arguments[@]:1}" >/dev/null 2>&1 &
  wait_until grep -qs . "$work/pids"
  expect 2 "${arguments[@]}" && expect_output "another sweep is writing"
  touch "$work/closed"
  wait $! || fail "the first one failed"
}

run_cases "$@"

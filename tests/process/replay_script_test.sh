#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# deploy/replay.sh, and real_logs.sh around it, with fake programs, and deploy/perturb_log.sh: what they check, pass on and
# leave behind.
#
# usage: tests/process/replay_script_test.sh [--list | CASE...]
# shellcheck disable=SC2317  # cases are called by name
# shellcheck source=tests/process/fake_stack.sh
source "$(dirname "${BASH_SOURCE[0]}")/fake_stack.sh"

replay_writes_its_row() {
  touch "$work/run.lcm" "$work/robot.toml"
  printf '[run]\nseed = 5  # seed\n' >"$work/scenario.toml"
  expect 0 replay.sh "$work/run.lcm" --estimator odometry --row control --set slam.a=1
  [[ -s $work/control/config.toml ]] || fail "no config.toml"
  [[ $(<"$work/control/timings.json") == '{"slam": {"messages": 12, "wall_s": 0.5},
"viewer": {"messages": 12, "wall_s": 0.5}}' ]] || fail "timings.json"
  [[ ! -e $work/control/slam.report ]] || fail "a report is left"
  grep -q -- "--set slam.seed=5 --set slam.estimator=odometry --set slam.a=1" "$work/slam.replay" || fail "slam"
}

replay_without_an_estimator_runs_the_configured_one() {
  touch "$work/run.lcm" "$work/robot.toml"
  expect 0 replay.sh "$work/run.lcm"
  [[ -s $work/fake_estimator/config.toml ]] || fail "no results in $work/fake_estimator"
  ! grep -q -- "--set slam.estimator" "$work/slam.replay" || fail "the estimator was set"
}

replay_finds_markers_in_images() {
  touch "$work/run.lcm" "$work/robot.toml"
  FAKE_channels='CAMERA LIDAR ODOMETRY' expect 0 replay.sh "$work/run.lcm" --estimator odometry --until-s 3
  expect_output "the log has images, but no markers"
  grep -q -- "--until-s 3 --log $work/run.lcm --out-log $work/odometry/markers.lcm" "$work/detector.replay" || fail "detector"
  grep -q -- "--log $work/run.lcm --log $work/odometry/markers.lcm --out-log" "$work/slam.replay" || fail "slam"
  grep -q detector "$work/odometry/timings.json" || fail "timings.json"
  rm "$work/detector.replay"
  FAKE_channels='CAMERA LIDAR MARKERS ODOMETRY' expect 0 replay.sh "$work/run.lcm" --estimator odometry
  [[ ! -e $work/detector.replay && ! -e $work/odometry/markers.lcm ]] || fail "a recording with markers was searched"
}

# replay_of_case CODE OPTION...: of a log that has been replayed into the same row before.
replay_of_case() {
  local code=$1 file
  mkdir -p "$work/odometry" "$work/logs"
  touch "$work/run.lcm" "$work/robot.toml" "$work/odometry/notes" "$work/logs/odometry.viewer.log"
  for file in config.toml map.pgm map.png trajectory.tum timings.json metrics.json slam.lcm; do
    echo "old" >"$work/odometry/$file"
  done
  expect "$code" replay.sh "$work/run.lcm" --estimator odometry "${@:2}"
}

replay_of_a_damaged_log_gives_what_is_left() {
  FAKE_slam_replayed=1 FAKE_viewer_replayed=1 replay_of_case 1
  expect_output "odometry is in $work/odometry, but not everything went well .see above and $work/logs/odometry.slam.log .*viewer.log"
  [[ -e $work/viewer.replay && -e $work/odometry/map.pgm ]] || fail "no map"
  grep -q messages "$work/odometry/timings.json" || fail "no timings"
}

failed_replay_leaves_no_old_results() {
  FAKE_slam_fails=--out-log replay_of_case 1 && expect_output "slam ended with code 1"
  [[ $(echo "$work/odometry/"*) == "$work/odometry/config.toml $work/odometry/notes" ]] || fail "left: $(ls "$work/odometry")"
  grep -q estimator "$work/odometry/config.toml" || fail "config.toml is the old one"
  [[ ! -e $work/logs/odometry.viewer.log ]] || fail "the old viewer.log is left"
  FAKE_slam_replayed=3 replay_of_case 3 && expect_output "slam ended with code 3"
  FAKE_viewer_mute=1 replay_of_case 1 && expect_output "the log has given no map; see $work/logs/odometry.slam.log"
}

refused_replay_leaves_old_results() {
  replay_of_case 2 --set slam.estimator=unknown && expect_output "got 'unknown'"
  grep -q old "$work/odometry/map.pgm" "$work/odometry/config.toml" || fail "the old results are gone"
  local option
  for option in "--config " "--load-map " "--save-map " "--set robot.markers.survey_file="; do
    # shellcheck disable=SC2086  # two words
    replay_of_case 2 $option"$work/odometry/map.pgm" && expect_output "map.pgm' belongs to the run"
    grep -q old "$work/odometry/map.pgm" || fail "the old results are gone"
  done
  replay_of_case 0 --config "$work/odometry/config.toml"
}

replay_into_a_row_that_cannot_be() {
  local name
  touch "$work/run.lcm" "$work/robot.toml"
  for name in ../run a/b . .. -x logs failed "$(printf 'x%.0s' {1..101})"; do
    expect 2 replay.sh "$work/run.lcm" --estimator odometry --row "$name"
    expect_output "'$name' is no name for a row"
  done
  expect 2 replay.sh "$work/run.lcm" --estimator unknown && expect_output "got 'unknown'"
  [[ ! -e $work/logs ]] || fail "something was written"
}

replay_needs_the_robot() {
  touch "$work/run.lcm"
  expect 2 replay.sh "$work/run.lcm" --estimator odometry && expect_output "say with --robot"
}

# logs_of_case CODE OPTION...: real_logs.sh over one log, with what an earlier run has left of the same row.
logs_of_case() {
  local code=$1 folder=$work/bench/short
  mkdir -p "$work/logs" "$folder"/{logs,odometry-s1}
  touch "$work/logs/short."{clf,relations}
  echo "estimator: 7 observations, 7 updates, 1.0 s of processor time, worst 2.0 ms" >"$folder/logs/odometry-s1.slam.log"
  echo "old" >"$folder/odometry-s1/trajectory.tum"
  expect "$code" real_logs.sh "$work/logs" --estimators odometry --out "$work/bench" "${@:2}"
}

real_logs_say_which_runs_have_failed() {
  local row=short,odometry,1
  logs_of_case 0
  grep -q "^$row,relations,0.5000,.*,9,9," "$work/bench/results.csv" || fail "no figures"
  FAKE_slam_refuses="--set slam.a=1" logs_of_case 1 --set slam.a=1 && expect_output "runs have failed"
  grep -qE "^$row,failed,+$" "$work/bench/results.csv" || fail "an earlier run's figures"
  FAKE_slam_replayed=1 logs_of_case 1
  grep -qE "^$row,failed,,.*,9,9," "$work/bench/results.csv" || fail "not everything went well, and the table does not say so"
  rm -r "$work/bench"
  logs_of_case 2 --set slam.estimator=unknown && expect_output "got 'unknown'"
  [[ ! -e $work/bench/short/run.lcm ]] || fail "something was done before the settings were checked"
}

# carmen_log_of_case: three scans of two beams in $work/in.clf, and a relation.
carmen_log_of_case() {
  local i
  for i in 1 2 3; do echo "FLASER 2 1.5 2.5 $i.0 0 0 $i.0 0 0 $i.25 host $i.25"; done >"$work/in.clf"
  echo "1.25 2.25 1.0 0 0 0 0 0" >"$work/in.relations"
}

# In a language, too, that writes numbers with a comma, and with folders for cd to search.
perturbed_log_is_as_told() {
  local bare=$work/share/waymark
  carmen_log_of_case
  ! command -v localedef >/dev/null || localedef -i de_DE -f UTF-8 "$work/de_DE.UTF-8" || true  # else it is English
  (cd "$bare" && CDPATH=. LOCPATH=$work LC_ALL=de_DE.UTF-8 deploy/perturb_log.sh "$work/in.clf" "$work/out.clf" \
    --every-s 1.5 --relations "$work/in.relations") >"$output" 2>&1 || fail "exit code $?"
  [[ ! -s $output ]] || fail "it should have been silent"
  [[ $(<"$work/out.clf") == "FLASER 2 1.5 2.5 1.000000 0.000000 0.000000 1.000000 0.000000 0.000000 1.250000 nohost 1.250000
FLASER 2 1.5 2.5 3.000000 0.000000 0.000000 3.000000 0.000000 0.000000 3.250000 nohost 3.250000" ]] || fail "out.clf"
  [[ $(<"$work/out.relations") == "1.250000 2.250000 1.000000 0.000000 0 0 0 0.000000" ]] || fail "out.relations"
  [[ -z $(compgen -G "$work/*.part") ]] || fail "a part is left"
}

perturb_log_refuses_what_cannot_be() {
  local value option
  carmen_log_of_case
  cp "$work/in.clf" "$work/in.copy"
  for value in 2cm -1 1,5 nan 0x1 ''; do
    for option in --noise-m --every-s --odometry-noise --odometry-step; do
      expect 2 perturb_log.sh "$work/in.clf" "$work/out.clf" $option "$value"
      expect_output "$option needs a number that is not below 0, not '$value'"
    done
  done
  expect 2 perturb_log.sh "$work/in.clf" "$work/out.clf" --seed one && expect_output "whole number, not 'one'"
  expect 2 perturb_log.sh "$work/in.clf" "$work/in.clf" && expect_output "would replace '$work/in.clf'"
  ln -s in.clf "$work/again.clf"
  expect 2 perturb_log.sh "$work/again.clf" "$work/in.clf" && expect_output "would replace"
  cp "$work/in.clf" "$work/IN.log"
  expect 2 perturb_log.sh "$work/IN.log" "$work/in.clf" --relations "$work/in.relations"
  expect_output "'$work/in.relations' would replace '$work/in.relations'"
  cmp "$work/in.clf" "$work/in.copy" || fail "the log is not what it was"
  [[ -s $work/in.relations && ! -e $work/out.clf ]] || fail "the relations are gone, or something was written"
}

run_cases "$@"

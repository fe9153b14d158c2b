#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# deploy/replay.sh with fake programs: what it checks, passes on and leaves behind.
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
  replay_of_case 2 --config "$work/odometry/map.pgm" && expect_output "map.pgm' belongs to the run"
  grep -q old "$work/odometry/map.pgm" || fail "the old results are gone"
  replay_of_case 0 --config "$work/odometry/config.toml"
}

replay_into_a_row_that_cannot_be() {
  local name
  touch "$work/run.lcm" "$work/robot.toml"
  for name in ../run a/b . .. -x logs failed "$(printf 'x%.0s' {1..101})"; do
    expect 2 replay.sh "$work/run.lcm" --estimator odometry --row "$name"
    expect_output "'$name' is no name for a row"
  done
  expect 2 replay.sh "$work/run.lcm" --estimator ../odometry && expect_output "no name for a row"
  [[ ! -e $work/logs ]] || fail "something was written"
}

replay_needs_the_robot() {
  touch "$work/run.lcm"
  expect 2 replay.sh "$work/run.lcm" --estimator odometry && expect_output "say with --robot"
}

run_cases "$@"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The stack under ThreadSanitizer: simulator, detector, slam, viewer and recorder, instrumented. A run in lockstep, its
# replays with three estimators, and a run in real time while clients load the live page. Any report fails. Libraries without
# instrumentation (MuJoCo, OSMesa, cpp-httplib, OpenCV, TBB) are not looked into; with TBB's threads ThreadSanitizer sees
# races that are none, so slam has one. Builds for ten minutes: no part of tests/run.sh.
#
# usage: tests/simulation/thread_sanitizer.sh
set -euo pipefail

case ${1:-} in
  --help | -h) sed -nE '3,/^set/{/^set/q; s/^# ?//p}' "$0" && exit 0 ;;
  ?*) echo "thread_sanitizer: takes no arguments (see --help)" >&2 && exit 2 ;;
esac
unset CDPATH
build_dir=$(cd "$(dirname "${BASH_SOURCE[0]}")/../.." && pwd)/build/tsan
# shellcheck source=tests/process/installed.sh
source "$(dirname "${BASH_SOURCE[0]}")/../process/installed.sh"
cd "$source_dir"
readonly scenario=tests/data/scenarios/smallest.toml page=127.0.0.1:$((20000 + $$ % 10000))
readonly under_test=(sim slam viewer recorder detector)
readonly deploy=$work/share/waymark/deploy

# expect_clean CODE WHAT: fails unless it ended well and nothing was reported.
expect_clean() {
  [[ $1 == 0 ]] && ! compgen -G "$work/race.*" >/dev/null && echo "thread_sanitizer: $2: clean" && return
  cat "$work"/race.* "$work/output" 2>/dev/null | head -n 100 >&2
  echo "thread_sanitizer: $2: code $1, or a report" >&2
  exit 1
}

run() { "$@" >"$work/output" 2>&1; }

cmake --preset tsan >/dev/null
cmake --build --preset tsan --target "${under_test[@]/#/waymark-}"

echo "deadlock:libgdal" >"$work/suppressions"  # takes its locks in two orders while OpenCV loads it
export TSAN_OPTIONS="exitcode=66 log_path=$work/race suppressions=$work/suppressions ignore_noninstrumented_modules=1"

code=0
run "$deploy/launch.sh" "$scenario" --out "$work/run" || code=$?
expect_clean $code lockstep
for estimator in waymark gmapping marker_matching; do
  run "$deploy/replay.sh" "$work/run/run.lcm" --estimator $estimator --out "$work/replays" || code=$?
  expect_clean $code "replay, $estimator"
done

run "$deploy/launch.sh" "$scenario" --out "$work/live" --real-time --http "$page" &
live=$!
while kill -0 $live 2>/dev/null; do
  for path in / /view /tiles /camera.jpg /command /events; do
    { curl -s --max-time 1 "http://$page$path" -o /dev/null && echo "$path" >>"$work/loaded"; } &
  done
  sleep 0.2
done
wait $live || code=$?
wait
expect_clean $code "real time, live page, loaded $(wc -l <"$work/loaded") times"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# Real logs from import to error with the real programs.
# The logs are third-party data beside the project: $WAYMARK_DATA or ../shared/data. Without them the
# test is skipped and says so.
#
# usage: tests/process/real_log_test.sh BUILD_DIR CASE
# shellcheck disable=SC2317  # cases are called by name
set -euo pipefail

build_dir=${1:?usage: real_log_test.sh BUILD_DIR CASE}
# shellcheck source=tests/process/installed.sh
source "$(dirname "${BASH_SOURCE[0]}")/installed.sh"
data=${WAYMARK_DATA:-$source_dir/../shared/data}/logs

need_log() {
  [[ -f $data/$1 ]] && return
  echo "skipped: no $data/$1"
  exit 77
}

# replay [ESTIMATOR]: with its default parameters.
replay() {
  local estimator=${1:-gmapping} config=()
  [[ $estimator != gmapping ]] || config=(--config "$source_dir/deploy/gmapping/slam_gmapping.toml")
  "$work/share/waymark/deploy/replay.sh" "$work/run.lcm" --estimator "$estimator" "${config[@]}" \
    --set slam.map_period_s=3600 >"$work/output" 2>&1 ||
    { cat "$work/output" >&2 && exit 1; }
}

# expect_at_most NAME BOUND: the figure of that name among those on standard input.
expect_at_most() {
  awk -v name="$1" -v bound="$2" '
    { print }
    index($1, name) == 1 { value = $2 }
    END { if (value == "" || value + 0 <= 0 || value + 0 > bound) { print "FAILED: more than " bound; exit 1 } }'
}

# The whole log, against the reference in it.
mbot() {
  need_log mbot_convex.lcm
  "$build_dir/waymark-import" mbot "$data/mbot_convex.lcm" --out "$work/run.lcm" \
    --encoder-channel MAEBOT_ENCODERS --reference-channel SLAM_POSE >/dev/null
  replay
  "$build_dir/waymark-evaluate" trajectory "$work/gmapping/trajectory_final.tum" "$work/reference.tum" \
    --align se2 | expect_at_most ate_se2_m 0.0070
}

# The first two minutes. The whole log: docs/gmapping.md.
fr079() {
  need_log fr079.clf.gz
  need_log fr079.relations
  local end_s=1340
  gzip -dc "$data/fr079.clf.gz" | awk -v end="$end_s" '$(NF - 2) < end' >"$work/start.clf"
  awk -v end="$end_s" '$1 < end - 1 && $2 < end - 1' "$data/fr079.relations" >"$work/start.relations"
  "$build_dir/waymark-import" carmen "$work/start.clf" --out "$work/run.lcm" >/dev/null
  replay
  "$build_dir/waymark-evaluate" relations "$work/gmapping/trajectory_final.tum" "$work/start.relations" |
    expect_at_most translation_mean_m 0.058
}

# Three people who walk along for the whole log; scans that follow them would end metres away.
people() {
  need_log fr079.clf.gz
  need_log fr079.relations
  "$source_dir/deploy/perturb_log.sh" "$data/fr079.clf.gz" "$work/perturbed/people.clf" --people
  "$build_dir/waymark-import" carmen "$work/perturbed/people.clf" --out "$work/run.lcm" >/dev/null
  replay waymark
  "$build_dir/waymark-evaluate" relations "$work/waymark/trajectory_final.tum" "$data/fr079.relations" |
    expect_at_most translation_mean_m 0.3
}

# The benchmark's table: every figure of a log with a reference, and the same again from the cache.
benchmark() {
  need_log mbot_convex.lcm
  local script=$work/share/waymark/deploy/real_logs.sh imported
  "$script" "$data" --logs mbot_convex --estimators gmapping,dead=odometry --out "$work/bench" >"$work/output" 2>&1 ||
    { cat "$work/output" >&2 && exit 1; }
  awk -F, '
    $1 == "mbot_convex" && $2 == "gmapping" { good = $4 == "ate" && $5 > 0 && $5 < 0.007 && $9 >= $5 && $14 == 459 && $15 > 0 && $16 > 0 && $18 > 0 }
    $2 == "dead" { worse = $5 > 0.05 }
    END { exit !(good && worse && NR == 3) }' "$work/bench/results.csv" ||
    { cat "$work/bench/results.csv" && echo "FAILED: not the figures of this log" && exit 1; }
  imported=$(stat -c %y "$work/bench/mbot_convex/run.lcm")
  "$script" "$data" --logs mbot_convex --estimators dead=odometry --out "$work/bench" >/dev/null 2>&1
  [[ $(stat -c %y "$work/bench/mbot_convex/run.lcm") == "$imported" ]] || { echo "FAILED: imported again" && exit 1; }
}

"${2:?usage: real_log_test.sh BUILD_DIR CASE}"

#!/usr/bin/env bash
# SPDX-License-Identifier: BSD-3-Clause
# The doctor on a simulated run with pictures: nothing is wrong with it, and of a description that is wrong in one place that
# place is named, and no other.
#
# usage: tests/process/doctor_test.sh BUILD_DIR
set -euo pipefail

build_dir=${1:?usage: doctor_test.sh BUILD_DIR}
# shellcheck source=tests/process/installed.sh
source "$(dirname "${BASH_SOURCE[0]}")/installed.sh"

fail() {
  echo "FAILED: $*" >&2
  cat "$work/output" >&2
  exit 1
}

# expect CODE NAMES OPTION...: the doctor ends with that code, and these checks, one a line, are no PASS.
expect() {
  local expected=$1 names=$2 code=0
  shift 2
  "$work/bin/waymark-doctor" "$work/run/run.lcm" "$@" >"$work/output" 2>"$work/errors" || code=$?
  ((code == expected)) || fail "exit code $code instead of $expected with $*"
  [[ $(sed -nE 's/^(WARN|FAIL)  ([a-z_]+) .*/\2/p' "$work/output") == "$names" ]] || fail "not '$names' with $*"
}

# wrong NAME EDIT: the run's description with an edit of sed's.
wrong() {
  sed -E "$2" "$work/run/robot.toml" >"$work/$1.toml"
  ! cmp -s "$work/run/robot.toml" "$work/$1.toml" || fail "nothing to edit for $1"
}

"$work/share/waymark/deploy/launch.sh" "$source_dir/deploy/scenarios/corridor_fast.toml" --out "$work/run" --record-only \
  >"$work/output" 2>&1 || fail "no run"
expect 0 ""
for check in camera_frames marker_dictionary blur marker_size camera_yaw camera_time_offset; do
  grep -q "^PASS  $check " "$work/output" || fail "$check is no PASS"
done

wrong marker_size 's/^size_m = .*/size_m = 0.4167/' # a print of 96 %
expect 1 marker_size --config "$work/marker_size.toml" --write-robot "$work/found.toml"
expect 0 "" --config "$work/found.toml"
wrong marker_dictionary 's/^dictionary = .*/dictionary = "DICT_4X4_50"/'
expect 1 marker_dictionary --config "$work/marker_dictionary.toml"
wrong focal_length 's/^(f[xy]_px) = .*/\1 = 480.0/'
expect 0 "" --config "$work/focal_length.toml" --write-robot "$work/unmeasured.toml" # a corridor does not determine it
grep -q '^----  focal_length ' "$work/output" || fail "focal_length is measured in a corridor"
grep -q '^fx_px = 480.0 ' "$work/unmeasured.toml" || fail "an unmeasured focal length is written"
wrong camera_frames 's/^width_px = .*/width_px = 800/'
expect 1 camera_frames --config "$work/camera_frames.toml"
wrong camera_yaw '/^\[robot.camera\]/,/^\[robot.markers\]/s/^yaw_rad = .*/yaw_rad = 0.06/'
expect 1 camera_yaw --config "$work/camera_yaw.toml"
wrong range_noise 's/^range_sigma_m = .*/range_sigma_m = 0.03/'
expect 0 range_noise --config "$work/range_noise.toml"
